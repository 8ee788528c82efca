// One verilated module behind a C interface that is the same for all modules: `tools/testbench/src/library.rs` is its caller.
//
// MODEL is the model's class, MODEL_HEADER its header. `description.inc` is a string literal, the ports and types of the module as
// JSON; `ports.inc` has a line PORT(name) for each port, in the same order. Ports are given out as addresses, so that setting and
// reading one costs no call.

#include <cstddef>
#include <cstdint>

#include MODEL_HEADER
#include "verilated.h"

struct module {
    VerilatedContext context;
    MODEL top;

    explicit module(uint32_t seed) : context(), top((prepare(seed), &context)) {}
    ~module() { top.final(); }

    // Registers start with noise that follows from the seed.
    void prepare(uint32_t seed) {
        context.threads(1);
        context.randReset(2);
        context.randSeed(static_cast<int>(seed & 0x7fffffff) | 1);
    }
};

extern "C" {

const char *module_description() {
    return
#include "description.inc"
        ;
}

module *module_new(uint32_t seed) { return new module(seed); }
void module_free(module *instance) { delete instance; }

// Where the bits of a port are: little-endian, 1, 2, 4 or 8 bytes, or whole 4-byte words of a wider one.
void *module_data(module *instance, size_t port) {
    size_t index = 0;
#define PORT(name) \
    if (port == index++) return &instance->top.name;
#include "ports.inc"
#undef PORT
    return nullptr;
}

// Lets the outputs follow the inputs.
void module_settle(module *instance) {
    instance->top.clk = 0;
    instance->top.eval();
}

// One rising edge, taking the inputs as they are, and the outputs after it.
void module_clock(module *instance) {
    module_settle(instance);
    instance->top.clk = 1;
    instance->top.eval();
    module_settle(instance);
}
}
