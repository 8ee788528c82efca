// One verilated design in a context of its own: what every library of a design has. See interface.h for the C interface around it.
//
// MODEL is the model's class, MODEL_HEADER its header.

#pragma once

#include <cstddef>
#include <cstdint>

#include MODEL_HEADER
#include "verilated.h"
#if VM_TRACE_VCD
#include <memory>

#include "verilated_vcd_c.h"
#endif

// Initial values of registers without a reset.
enum class Registers { ZERO, NOISE };

struct Harness {
    VerilatedContext context;
    MODEL top;
    // Time units of an evaluation in waveforms.
    uint64_t step = 1;
#if VM_TRACE_VCD
    std::unique_ptr<VerilatedVcdC> trace;
#endif

    explicit Harness(uint32_t seed, Registers registers = Registers::NOISE)
        : context(), top((prepare(seed, registers), &context), "top") {}

    ~Harness() {
#if VM_TRACE_VCD
        if (trace) trace->close();
#endif
        top.final();
        // The destructor of a model uses the thread's context, which may be another instance's.
        Verilated::threadContextp(&context);
    }

    Harness(const Harness &) = delete;
    Harness &operator=(const Harness &) = delete;

    // Single-threaded model, with noise from the seed.
    void prepare(uint32_t seed, Registers registers) {
        context.threads(1);
        context.randReset(registers == Registers::NOISE ? 2 : 0);
        context.randSeed(static_cast<int>(seed & 0x7fffffff) | 1);
    }

    void eval() {
        top.eval();
#if VM_TRACE_VCD
        if (trace) trace->dump(context.time());
        context.timeInc(step);
#endif
    }

    // Starts writing waveforms, before the first evaluation. False in a library without waveforms.
    bool write_waveforms(const char *path) {
#if VM_TRACE_VCD
        context.traceEverOn(true);
        trace = std::make_unique<VerilatedVcdC>();
        top.trace(trace.get(), 99);
        trace->open(path);
        return trace->isOpen();
#else
        (void)path;
        return false;
#endif
    }
};
