// The C interface of a verilated design, the same for all: `tools/testbench/src/library.rs` is its caller.
//
// INSTANCE is a struct derived from Harness that is made from a seed. `description.inc` is a string literal, the ports and types of
// the design as JSON; `ports.inc` has a line PORT(name) for each port, in the same order. Ports are given out as addresses, so that
// setting and reading one costs no call.
//
// Instances share nothing. An instance may move between threads, and is used by one at a time.

#pragma once

#include "harness.h"

#pragma GCC visibility push(default)
extern "C" {

// Changes with every change of this interface.
uint32_t harness_version() { return 1; }

const char *harness_description() {
    return
#include "description.inc"
        ;
}

// A design before its first evaluation.
INSTANCE *harness_new(uint32_t seed) { return new INSTANCE(seed); }
void harness_free(INSTANCE *instance) { delete instance; }

// Address of a port's bits: little-endian, 1, 2, 4 or 8 bytes, or whole 4-byte words of a wider port.
void *harness_port(INSTANCE *instance, size_t port) {
    size_t index = 0;
#define PORT(name) \
    if (port == index++) return &instance->top.name;
#include "ports.inc"
#undef PORT
    return nullptr;
}

// Lets the design follow its inputs, clocks among them.
void harness_eval(INSTANCE *instance) { instance->eval(); }

// As Harness::write_waveforms: 1 when it writes them.
int harness_waveforms(INSTANCE *instance, const char *path) { return instance->write_waveforms(path); }

}  // extern "C"
#pragma GCC visibility pop
