# Stores a count to the word of DDR3 at the address WORD, then shows the count on the LEDs.
    .option norelax
    li   s0, WORD
    li   s1, LEDS_OUT
    li   s2, 0
again:
    addi s2, s2, 1
    sw   s2, 0(s0)
    sw   s2, 0(s1)
    j    again
