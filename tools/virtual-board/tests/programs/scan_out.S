# Shows the frame at FRAME with the scale at PARAMETERS, and one frame later the frame whose address is in the next word.
# Meanwhile it reads and writes memory at full speed. The LEDs show the underflow count.
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
