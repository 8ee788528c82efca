/* The verilated SoC behind a C interface: clocks, pins, and back doors to its memories.
 *
 * One instance is one board. Instances share nothing; an instance may move between threads, but is used by one at a
 * time. No function fails on a valid instance and arguments in range; what "in range" is stands at each function.
 */
#ifndef GLINT_SOC_H
#define GLINT_SOC_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Everything else in the library is hidden. */
#pragma GCC visibility push(default)

/* Changes with every change of this interface. */
#define GLINT_SOC_ABI 3

typedef struct glint_soc glint_soc;

/* GLINT_SOC_ABI of the library. */
uint32_t glint_soc_abi(void);
/* CRC-32 of the register map, as in the register identity_build_id. */
uint32_t glint_soc_build_id(void);
/* Frequency of sys_clk in Hz. */
uint32_t glint_soc_clock_hz(void);

/* A board before its first clock edge, with the BIOS in ROM and all memory zero. */
glint_soc *glint_soc_new(void);
void glint_soc_free(glint_soc *soc);

/* Starts writing waveforms to `path`. 1 if done, 0 if the library was built without waveforms. */
int glint_soc_trace(glint_soc *soc, const char *path);

/* Runs `cycles` cycles of sys_clk; pix_clk runs along at 297/325 of its rate. */
void glint_soc_run(glint_soc *soc, uint64_t cycles);
/* The same, but nothing is done except moving the clocks and evaluating the model: the measure of what the harness
 * costs. What the SoC sends meanwhile is lost. */
void glint_soc_run_bare(glint_soc *soc, uint64_t cycles);
/* Cycles of sys_clk so far. */
uint64_t glint_soc_cycles(const glint_soc *soc);

/* Queues bytes for the SoC's UART, which takes them as fast as its FIFO allows. */
void glint_soc_uart_write(glint_soc *soc, const uint8_t *bytes, size_t length);
/* Bytes queued and not yet taken. */
size_t glint_soc_uart_queued(const glint_soc *soc);
/* Moves up to `capacity` bytes that the SoC sent to `bytes`; returns how many. */
size_t glint_soc_uart_read(glint_soc *soc, uint8_t *bytes, size_t capacity);

void glint_soc_set_buttons(glint_soc *soc, uint8_t pressed);
void glint_soc_set_switches(glint_soc *soc, uint16_t on);
uint16_t glint_soc_leds(const glint_soc *soc);

/* What devices on the I2C bus do to the wires (0 pulls low, 1 releases). Bit 0 is SCL, bit 1 is SDA. */
void glint_soc_i2c_drive(glint_soc *soc, uint8_t released);
/* State of the wires, in the same bits. */
uint8_t glint_soc_i2c_wires(const glint_soc *soc);
/* What the SoC does to the wires, in the same bits. */
uint8_t glint_soc_i2c_released(const glint_soc *soc);
/* As glint_soc_run, but returns after the first cycle in which that has changed. Returns how many cycles have been run. */
uint64_t glint_soc_run_to_i2c(glint_soc *soc, uint64_t cycles);

/* Whether the pins of the monitor are recorded; off at first. */
void glint_soc_video_record(glint_soc *soc, int on);
/* Samples since the last call of glint_soc_video_clear, one a tick of pix_clk:
 * bit 26 vsync, bit 25 hsync, bit 24 de, bits 23:16 red, 15:8 green, 7:0 blue. Valid until the next run or clear. */
const uint32_t *glint_soc_video_samples(const glint_soc *soc, size_t *count);
void glint_soc_video_clear(glint_soc *soc);

/* Reads or writes DDR3, `offset` bytes into main RAM; offset + length must be at most 128 MiB. Both run a
 * board that has run for about a thousand cycles more, so that stores on their way to memory arrive first. A write
 * drops what the CPU's caches hold, so that loads and fetches that start after it see it. */
void glint_soc_ddr_read(glint_soc *soc, uint32_t offset, uint8_t *bytes, size_t length);
void glint_soc_ddr_write(glint_soc *soc, uint32_t offset, const uint8_t *bytes, size_t length);

/* Replaces the whole ROM, zero after `length`, which must be at most 64 KiB; before the first cycle. */
void glint_soc_rom_write(glint_soc *soc, const uint8_t *bytes, size_t length);

#pragma GCC visibility pop

#ifdef __cplusplus
}
#endif

#endif
