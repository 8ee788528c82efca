# Loop: reads WHO_AM_I of an MPU-6050 and shows the whole register `answer`, status included, on the LEDs.
    .option norelax
    li   s0, COMMAND
    li   s1, ANSWER
    li   s2, LEDS_OUT
again:
    li   t0, 0x000              # start
    sw   t0, 0(s0)
    li   t0, 0x1d0              # write to 0x68:
    sw   t0, 0(s0)
    li   t0, 0x175              # the register
    sw   t0, 0(s0)
    li   t0, 0x000              # start
    sw   t0, 0(s0)
    li   t0, 0x1d1              # read from 0x68:
    sw   t0, 0(s0)
    li   t0, 0x200              # a byte
    sw   t0, 0(s0)
    li   t0, 0x300              # stop
    sw   t0, 0(s0)
wait:
    lw   t0, 0(s1)
    andi t1, t0, 0x100
    beqz t1, wait
    sw   t0, 0(s2)
    j    again
