# Stores a count to a word of DDR3, then to the LEDs.
    .option norelax
    li   s0, WORD
    li   s1, LEDS_OUT
    li   s2, 0
again:
    addi s2, s2, 1
    sw   s2, 0(s0)
    sw   s2, 0(s1)
    j    again
