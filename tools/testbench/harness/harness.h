// Harness of a verilated design: one instance of the model with its own Verilator context. Every library of a design contains
// this code; interface.h adds the C interface.
//
// The build defines MODEL as the class of the verilated model, MODEL_HEADER as the header of that class, and MODEL_EVAL as the function
// that its method `eval` calls to evaluate the design.

#pragma once

#include <cstddef>
#include <cstdint>

#include MODEL_HEADER
#include "verilated.h"

#if VM_TRACE_VCD
#include <memory>

#include "verilated_vcd_c.h"
#endif

void MODEL_EVAL(decltype(MODEL::rootp));

// Initial values of registers that have no reset.
enum class Registers { ZERO, NOISE };

struct Harness {
    VerilatedContext context;
    MODEL top;
    bool is_initialised = false;
    // Time units by which each evaluation advances the time in the waveforms.
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
        // The destructor of the model uses the current thread's context, which may belong to another instance.
        Verilated::threadContextp(&context);
    }

    Harness(const Harness &) = delete;
    Harness &operator=(const Harness &) = delete;

    // Makes the model single-threaded, and sets the seed of the noise in registers without a reset.
    void prepare(uint32_t seed, Registers registers) {
        context.threads(1);
        context.randReset(registers == Registers::NOISE ? 2 : 0);
        context.randSeed(static_cast<int>(seed & 0x7fffffff) | 1);
    }

    void eval() {
#if VM_TRACE_VCD
        top.eval();
        if (trace) trace->dump(context.time());
        context.timeInc(step);
#else
        // The method is necessary only before the first evaluation: then it sets the initial values. Each call also takes locks, for
        // messages and for deleted objects, of which the designs have none.
        if (is_initialised) {
            MODEL_EVAL(top.rootp);
        } else {
            top.eval();
            is_initialised = true;
        }
#endif
    }

    // Starts writing waveforms to a file; call it before the first evaluation. Returns false when nothing can be written,
    // as in a library that was built without waveforms.
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
