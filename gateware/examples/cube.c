// Draws a cube and shows it, on the processor of a LiteX SoC, by the functions that LiteX and glint_gen write. The end of the raster pass
// raises an interrupt. `ctrl_scratch` reports the result: 0, or the number of the check that failed.

#include <generated/mem.h>
#include <irq.h>

#include "cube.h"

static volatile int raster_passes = 0;

// Called by the trap handler of start.S.
void isr(void) {
    triangle_ev_pending_write(triangle_ev_pending_read());
    ++raster_passes;
}

int main(void) {
    triangle_ev_enable_write(1 << CSR_TRIANGLE_EV_ENABLE_RASTER_OFFSET);
    irq_setmask(1 << TRIANGLE_INTERRUPT);
    irq_setie(1);
    int failed = draw_cube(MAIN_RAM_BASE);
    scanout_fb_next_write(MAIN_RAM_BASE);
    scanout_scale_write(1);
    scanout_control_write(1);
    ctrl_scratch_write(failed ? failed : raster_passes == 1 ? 0 : 100 + raster_passes);
    for (;;) {}
}
