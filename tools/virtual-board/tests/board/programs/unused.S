# Accesses addresses that no memory and no register has. Before the first access and after each one, stores the count of bus errors and
# the cycle at RESULTS; finally stores a word that is not 0 behind them.
    .option norelax
    .option arch, +zicsr
    .macro store
    lw   t0, 0(s0)
    sw   t0, 0(s1)
    csrr t0, mcycle
    sw   t0, 4(s1)
    addi s1, s1, 8
    .endm

    li   s0, BUS_ERRORS
    li   s1, RESULTS
    li   s2, UNUSED
    li   s3, UNUSED_IO
    store
    lw   t0, 4(s2)
    store
    sw   t0, 4(s2)
    store
    lw   t0, 4(s3)
    store
    sw   t0, 4(s3)
    store
    sw   s1, 0(s1)
again:
    j    again
