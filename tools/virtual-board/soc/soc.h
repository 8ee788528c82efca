/* The verilated SoC: clocks, the pins of its devices, and back doors to its memories, beside the interface of
 * tools/testbench/harness/interface.h. An instance before its first cycle has the BIOS in ROM and zeros in all memories.
 *
 * No function fails if the instance is valid and the arguments are within the stated limits. This interface and interface.h have
 * one common version number, which changes with either of them.
 */
#ifndef SOC_H
#define SOC_H

#include <cstddef>
#include <cstdint>

extern "C" {

/* All other symbols of the library are hidden. */
#pragma GCC visibility push(default)

struct Soc;

/* CRC-32 of the register map, as in the register identity_build_id. */
uint32_t soc_build_id(void);
/* Frequency of sys_clk in Hz. */
uint32_t soc_clock_hz(void);

/* Runs `cycles` cycles of sys_clk; pix_clk advances in proportion, at 74.25 MHz. */
void soc_run(Soc *soc, uint64_t cycles);
/* Like soc_run, but only drives the clocks and evaluates the model, to measure the cost of the rest of the harness. The SoC's
 * serial output of these cycles is lost. */
void soc_run_bare(Soc *soc, uint64_t cycles);
/* Cycles of sys_clk so far. */
uint64_t soc_cycles(const Soc *soc);

/* Queues bytes for the SoC's UART, which takes them as fast as its FIFO allows. */
void soc_uart_write(Soc *soc, const uint8_t *bytes, size_t length);
/* Number of queued bytes that the UART has not taken yet. */
size_t soc_uart_queued(const Soc *soc);
/* Moves up to `capacity` bytes of the SoC's serial output to `bytes`; returns the number of bytes. */
size_t soc_uart_read(Soc *soc, uint8_t *bytes, size_t capacity);

/* Sets how the devices on the I2C bus drive its wires. Bit 0 is for SCL, bit 1 for SDA; 0 pulls the wire low, 1 releases it. */
void soc_i2c_drive(Soc *soc, uint8_t released);
/* Levels of the I2C wires: SCL in bit 0, SDA in bit 1. */
uint8_t soc_i2c_wires(const Soc *soc);
/* Outputs of the SoC to devices that react to each edge. Bits 0 and 1: SCL and SDA of the I2C bus, bits 2 and 3: SCL and SDA of the
 * image sensor's SCCB bus, each coded as for soc_i2c_drive. Bit 4: the image sensor's RESET_N, bit 5: its PWDN. Bit 6: CS# of the
 * flash, bit 7: its clock. */
uint8_t soc_outputs(const Soc *soc);
/* Like soc_run, but stops after the first cycle in which the value of soc_outputs changes. Returns the number of
 * cycles run. */
uint64_t soc_run_to_edge(Soc *soc, uint64_t cycles);

/* Sets how the image sensor drives its SCCB wires, coded as for soc_i2c_drive. */
void soc_camera_drive(Soc *soc, uint8_t released);
/* Queues levels of the image sensor's port, one entry for each period of PCLK. `frequency` is the frequency of PCLK in Hz, a multiple of 250 kHz
 * and at most the frequency of sys_clk. The levels change at the beginning of the period, PCLK rises in its middle. Bits 7:0: data,
 * bit 8: HREF, bit 9: VSYNC, bit 10: PCLK is stopped, bit 11: PCLK is inverted. While the queue is empty, nothing changes. */
void soc_camera_send(Soc *soc, uint32_t frequency, const uint16_t *levels, size_t count);
/* Number of queued periods. */
size_t soc_camera_queued(const Soc *soc);
void soc_camera_clear(Soc *soc);
/* Periods of the master clock XCLK that the SoC has sent to the image sensor so far. */
uint64_t soc_camera_clocks(const Soc *soc);

/* Sets the levels of the flash's four data lines as the SoC sees them; all are high at first. */
void soc_flash_drive(Soc *soc, uint8_t lines);
/* Levels with which the SoC drives these lines; lines that it does not drive are high. */
uint8_t soc_flash_lines(const Soc *soc);

/* Turns the recording of the video pins on or off; it is off at first. */
void soc_video_record(Soc *soc, int on);
/* Samples of the video pins since the last call of soc_video_clear, one per tick of pix_clk:
 * bit 26 vsync, bit 25 hsync, bit 24 de, bits 23:16 red, 15:8 green, 7:0 blue. Valid until the next run or clear. */
const uint32_t *soc_video_samples(const Soc *soc, size_t *count);
void soc_video_clear(Soc *soc);

/* An instruction that the CPU has executed. */
struct SocInstruction {
    uint64_t cycle;         /* Cycle of sys_clk in which the instruction ended. */
    uint32_t pc;            /* Address of the instruction. */
    uint32_t rd;            /* Number of the register that the instruction wrote, 0 for none. */
    uint32_t value;         /* Value that the instruction wrote to the register. */
};
/* Turns the recording of executed instructions on or off; it is off at first. */
void soc_instructions_record(Soc *soc, int on);
/* Instructions since the last call of soc_instructions_clear, in the order of execution. Valid until the next run or clear. */
const SocInstruction *soc_instructions(const Soc *soc, size_t *count);
void soc_instructions_clear(Soc *soc);

/* Whether the CPU is filling a cache line. The fill uses the memory's old data, even if soc_ddr_write changes them. */
int soc_filling(const Soc *soc);
/* Reads or writes DDR3, `offset` bytes into main RAM; offset + length must be at most 128 MiB. A store of the CPU reaches memory within a
 * thousand cycles. A write invalidates the CPU's caches, so that later loads and instruction fetches see the new data; it must not be
 * called while soc_filling returns 1. */
void soc_ddr_read(Soc *soc, uint32_t offset, uint8_t *bytes, size_t length);
void soc_ddr_write(Soc *soc, uint32_t offset, const uint8_t *bytes, size_t length);

/* Replaces the contents of the ROM, filled up with zeros. `length` must be at most the size of the ROM. Call this before the
 * first cycle. */
void soc_rom_write(Soc *soc, const uint8_t *bytes, size_t length);

#pragma GCC visibility pop

}

#endif
