# Lights the segments LEFT_SHOWN and RIGHT_SHOWN of the two digit displays.
    .option norelax
    li   s0, LEFT
    li   s1, LEFT_SHOWN
    sw   s1, 0(s0)
    li   s0, RIGHT
    li   s1, RIGHT_SHOWN
    sw   s1, 0(s0)
again:
    j    again
