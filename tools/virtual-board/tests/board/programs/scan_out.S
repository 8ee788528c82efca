# Shows the frame at the address FRAME, with the scale in the word at the address PARAMETERS. One video frame later, shows the
# frame whose address is in the word after the scale. Meanwhile the program reads and writes memory at full speed, and shows
# scan-out's count of underflows on the LEDs.
    .option norelax
    li   s0, SCANOUT
    li   s1, PARAMETERS
    li   s2, LEDS_OUT
    li   s3, TRAFFIC
    li   s4, TRAFFIC + 0x10000

    li   t0, FRAME
    sw   t0, FB_NEXT(s0)
    lw   t0, 0(s1)
    sw   t0, SCALE(s0)
    li   t0, 1
    sw   t0, CONTROL(s0)
    li   s5, 0

# Each pass of the loop has two cache misses and two stores. The loop covers 64 KiB, so that rows and banks change.
again:
    mv   t0, s3
traffic:
    lw   t1, 0(t0)
    lw   t2, 32(t0)
    sw   t2, 0(t0)
    sw   t1, 32(t0)
    addi t0, t0, 64
    bltu t0, s4, traffic

    lw   t0, UNDERFLOW_COUNT(s0)
    sw   t0, 0(s2)
    lw   t0, FB_CURRENT(s0)
    li   t1, FRAME
    bne  t0, t1, again
    lw   t0, 4(s1)
    sw   t0, FB_NEXT(s0)
    j    again
