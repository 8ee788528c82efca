# In a loop, reads the register WHO_AM_I of an MPU-6050, and shows the I2C engine's whole register `answer`, with its status
# bits, on the LEDs.
    .option norelax
    li   s0, COMMAND
    li   s1, ANSWER
    li   s2, LEDS_OUT
again:
    li   t0, 0x000              # start
    sw   t0, 0(s0)
    li   t0, 0x1d0              # write address 0x68 for writing
    sw   t0, 0(s0)
    li   t0, 0x175              # write the number of the register
    sw   t0, 0(s0)
    li   t0, 0x000              # start
    sw   t0, 0(s0)
    li   t0, 0x1d1              # write address 0x68 for reading
    sw   t0, 0(s0)
    li   t0, 0x200              # read a byte
    sw   t0, 0(s0)
    li   t0, 0x300              # stop
    sw   t0, 0(s0)
wait:
    lw   t0, 0(s1)
    andi t1, t0, 0x100
    beqz t1, wait
    sw   t0, 0(s2)
    j    again
