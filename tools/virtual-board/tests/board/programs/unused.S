# Accesses addresses without a memory or a register. Before the first access and after each access,
# appends the count of bus errors and the cycle to the results at RESULTS; finally appends a word
# that is not 0.
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
