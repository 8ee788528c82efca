// The C interface of a verilated design, which is the same for all designs. Its caller is `tools/testbench/src/library.rs`.
//
// INSTANCE is a struct derived from Harness that is made from a seed. `description.inc` is a string literal, the ports and types
// of the design as JSON; `ports.inc` has a line PORT(name) for each port, in the same order. The caller gets the address of each
// port, so that setting or reading a port needs no call.
//
// Instances share nothing. An instance may move between threads, but only one thread at a time may use it.

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

// Returns the address of the bits of port number `port`, or null if there is no such port. The bits are little-endian, in 1, 2, 4
// or 8 bytes, or in whole 4-byte words if the port has more than 64 bits.
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
