// Runs the SoC from its reset to the BIOS's prompt, for the compiler's profile. See gateware/verilate/board.py.

#include "soc.h"

// Number of cycles to run. By then the BIOS has trained and tested the memory, and waits for a serial boot.
constexpr uint64_t CYCLES = 1000000;

extern "C" Soc *harness_new(uint32_t seed);
extern "C" void harness_free(Soc *soc);

int main() {
    Soc *soc = harness_new(1);
    soc_run(soc, CYCLES);
    harness_free(soc);
}
