/* The verilated SoC: clocks, the pins of its devices, and back doors to its memories, beside the interface of
 * tools/testbench/harness/interface.h. An instance before its first cycle has the BIOS in ROM and zeros in all memories.
 *
 * No function fails on a valid instance and arguments within the limits that it states. Both interfaces have one version: it changes
 * with either.
 */
#ifndef SOC_H
#define SOC_H

#include <cstddef>
#include <cstdint>

extern "C" {

/* Everything else in the library is hidden. */
#pragma GCC visibility push(default)

struct Soc;

/* CRC-32 of the register map, as in the register identity_build_id. */
uint32_t soc_build_id(void);
/* Frequency of sys_clk in Hz. */
uint32_t soc_clock_hz(void);

/* Runs `cycles` cycles of sys_clk; pix_clk runs along at 297/325 of its rate. */
void soc_run(Soc *soc, uint64_t cycles);
/* As soc_run, but only moves the clocks and evaluates the model, to measure what the rest of the harness costs. Serial
 * output of the SoC is lost meanwhile. */
void soc_run_bare(Soc *soc, uint64_t cycles);
/* Cycles of sys_clk so far. */
uint64_t soc_cycles(const Soc *soc);

/* Queues bytes for the SoC's UART, which takes them as fast as its FIFO allows. */
void soc_uart_write(Soc *soc, const uint8_t *bytes, size_t length);
/* Bytes queued and not yet taken. */
size_t soc_uart_queued(const Soc *soc);
/* Moves up to `capacity` bytes of the SoC's serial output to `bytes`; returns the number of bytes. */
size_t soc_uart_read(Soc *soc, uint8_t *bytes, size_t capacity);

/* Sets what the devices on the I2C bus do to the wires (0 pulls low, 1 releases). Bit 0 is SCL, bit 1 is SDA. */
void soc_i2c_drive(Soc *soc, uint8_t released);
/* State of the wires, in the same bits. */
uint8_t soc_i2c_wires(const Soc *soc);
/* What the SoC does to the wires, in the same bits. */
uint8_t soc_i2c_released(const Soc *soc);
/* As soc_run, but stops after the first cycle in which the value of soc_i2c_released changes. Returns the number of
 * cycles run. */
uint64_t soc_run_to_i2c(Soc *soc, uint64_t cycles);

/* Turns the recording of the video pins on or off; it is off at first. */
void soc_video_record(Soc *soc, int on);
/* Samples since the last call of soc_video_clear, one a tick of pix_clk:
 * bit 26 vsync, bit 25 hsync, bit 24 de, bits 23:16 red, 15:8 green, 7:0 blue. Valid until the next run or clear. */
const uint32_t *soc_video_samples(const Soc *soc, size_t *count);
void soc_video_clear(Soc *soc);

/* Reads or writes DDR3, `offset` bytes into main RAM; offset + length must be at most 128 MiB. If the
 * SoC has run before, both first run it for about a thousand cycles, so that pending stores reach memory. A write
 * empties the CPU's caches, so that later loads and fetches of instructions see the new data. */
void soc_ddr_read(Soc *soc, uint32_t offset, uint8_t *bytes, size_t length);
void soc_ddr_write(Soc *soc, uint32_t offset, const uint8_t *bytes, size_t length);

/* Replaces the whole ROM, zero after `length`, which must be at most 64 KiB; before the first cycle. */
void soc_rom_write(Soc *soc, const uint8_t *bytes, size_t length);

#pragma GCC visibility pop

}

#endif
