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

// Version of this interface, to be increased with every change of the interface.
uint32_t harness_version() { return 1; }

const char *harness_description() {
    return
#include "description.inc"
        ;
}

// Creates an instance of the design, before its first evaluation.
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

// Evaluates the design for its current inputs, which include the clocks.
void harness_eval(INSTANCE *instance) { instance->eval(); }

// Calls Harness::write_waveforms; returns 1 when waveforms are written, else 0.
int harness_waveforms(INSTANCE *instance, const char *path) { return instance->write_waveforms(path); }

}  // extern "C"
#pragma GCC visibility pop
