// Runs the SoC from its reset to the BIOS's prompt, so that the compiler's profile knows what a SoC mostly does. See verilate in
// tools/xtask/src/gateware.rs.

#include "glint_soc.h"

// The BIOS has trained the memory, tested it and waits for a serial boot.
constexpr uint64_t CYCLES = 1000000;

int main() {
    glint_soc *soc = glint_soc_new();
    glint_soc_run(soc, CYCLES);
    glint_soc_free(soc);
}
