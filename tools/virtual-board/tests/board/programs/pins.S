# Shows on LEDs 15:8 the switches 15:8, on LEDs 7:4 the buttons 3:0, and on LEDs 3:0 four bits of a
# word in DDR3. The word is in the data cache. In 16 of 32 rounds a load evicts it; in the other 16
# rounds it stays in the cache. A test replaces the instruction at `patch` at run time.
    .option norelax
    li   s0, BUTTONS_IN
    li   s1, SWITCHES_IN
    li   s2, LEDS_OUT
    li   s3, WORD
    li   s4, WORD + 4096
    li   s5, 0xff00
    li   s6, 0
round:
    addi s6, s6, 1
    andi t0, s6, 16
    beqz t0, stay
    lw   zero, 0(s4)
stay:
    lw   t0, 0(s0)
    lw   t1, 0(s1)
    lw   t2, 0(s3)
    and  t1, t1, s5
    andi t2, t2, 15
patch:
    addi t2, t2, 0
    andi t2, t2, 15
    slli t0, t0, 4
    or   t0, t0, t1
    or   t0, t0, t2
    sw   t0, 0(s2)
    j    round
