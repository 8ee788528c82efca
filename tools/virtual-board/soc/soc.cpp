// The verilated SoC in its harness: clocks, the pins of its devices, and back doors to its memories. See soc.h for the contract.

#include "soc.h"

#include <algorithm>
#include <cstring>
#include <deque>
#include <vector>

#include "Vmodel___024root.h"
#include "generated/mem.h"
#include "generated/soc.h"
#include "harness.h"

// The BIOS, embedded in the library so that no file is needed at run time.
asm(".section .rodata\n"
    ".balign 4\n"
    "glint_bios:\n"
    ".incbin \"" GLINT_BIOS "\"\n"
    "glint_bios_end:\n"
    ".previous\n");
extern "C" const uint8_t glint_bios[] __attribute__((visibility("hidden")));
extern "C" const uint8_t glint_bios_end[] __attribute__((visibility("hidden")));

namespace {

// Ratio of the clock frequencies: pix_clk / sys_clk = PIXEL_TICKS / PIXEL_PERIOD, in units of 250
// kHz.
constexpr uint32_t CLOCK_UNIT = 250'000;
constexpr uint32_t PIXEL_TICKS = 74'250'000 / CLOCK_UNIT;
constexpr uint32_t PIXEL_PERIOD = CONFIG_CLOCK_FREQUENCY / CLOCK_UNIT;
static_assert(CONFIG_CLOCK_FREQUENCY % CLOCK_UNIT == 0 && PIXEL_TICKS < PIXEL_PERIOD);

// Flags in the levels of the image sensor's port, as for soc_camera_send.
constexpr uint16_t CAMERA_STILL = 1 << 10;
constexpr uint16_t CAMERA_INVERTED = 1 << 11;
// First bit of the image sensor's SCCB wires in soc_outputs.
constexpr int CAMERA_OUTPUTS = 2;

// Levels of the flash's data lines while nothing drives them.
constexpr uint8_t FLASH_RELEASED = 0xf;

// Half a period of sys_clk in picoseconds, the unit of time in waveforms.
constexpr uint64_t HALF_PERIOD_PS = 500'000'000'000ull / CONFIG_CLOCK_FREQUENCY;

}  // namespace

struct Soc : Harness {
    uint64_t cycles = 0;
    uint32_t pixel_phase = 0;
    std::deque<uint8_t> uart_in;
    std::deque<uint8_t> uart_out;
    uint8_t i2c_released = 3;
    uint8_t camera_released = 3;
    // PCLK has camera_ticks periods in PIXEL_PERIOD cycles of sys_clk. Each period of PCLK has one
    // entry in camera_levels.
    uint32_t camera_ticks = 0;
    uint32_t camera_phase = 0;
    bool camera_second_half = false;
    std::deque<uint16_t> camera_levels;
    uint64_t camera_clocks = 0;
    bool video_on = false;
    std::vector<uint32_t> video;
    bool instructions_on = false;
    std::vector<SocInstruction> instructions;

    explicit Soc(uint32_t seed) : Harness(seed, Registers::ZERO) {
        step = HALF_PERIOD_PS;
        top.serial_source_ready = 1;
        top.i2c_scl_in = 1;
        top.i2c_sda_in = 1;
        top.camera_scl_in = 1;
        top.camera_sda_in = 1;
        top.flash_dq_in = FLASH_RELEASED;
        rom_write(glint_bios, static_cast<size_t>(glint_bios_end - glint_bios));
    }

    void cycle() {
        // Rising edge of sys_clk, at which the SoC samples its input pins.
        const bool sent = top.serial_source_valid;
        const uint8_t sent_byte = top.serial_source_data;
        const bool taken = top.serial_sink_valid && top.serial_sink_ready;
        const bool clocked = top.camera_xclk;
        move_camera();
        if (instructions_on) record_instruction();
        top.sys_clk = 1;
        top.pix_clk = 0;
        eval();
        camera_clocks += !clocked && top.camera_xclk;

        // Input pins change between the edges. pix_clk rises at the falling edge of sys_clk, so two evaluations per cycle serve
        // both clocks.
        if (sent) uart_out.push_back(sent_byte);
        if (taken) uart_in.pop_front();
        top.serial_sink_valid = !uart_in.empty();
        if (!uart_in.empty()) top.serial_sink_data = uart_in.front();
        const uint8_t wires = i2c_wires();
        top.i2c_scl_in = wires & 1;
        top.i2c_sda_in = wires >> 1;
        const uint8_t camera_wires = camera_released & outputs() >> CAMERA_OUTPUTS;
        top.camera_scl_in = camera_wires & 1;
        top.camera_sda_in = camera_wires >> 1 & 1;
        move_camera();
        const bool tick = pixel_tick();
        top.sys_clk = 0;
        top.pix_clk = tick;
        eval();
        if (tick && video_on) record_pixel();
        ++cycles;
    }

    void record_pixel() {
        video.push_back(uint32_t(top.vga_vsync) << 26 | uint32_t(top.vga_hsync) << 25 | uint32_t(top.vga_de) << 24 |
                        uint32_t(top.vga_r) << 16 | uint32_t(top.vga_g) << 8 | uint32_t(top.vga_b));
    }

    // Records the instruction that leaves the last stage of the CPU at the next edge, if any.
    void record_instruction() {
        const auto *root = top.rootp;
        if (!root->glint_virtual__DOT__VexRiscv__DOT__lastStageIsFiring) return;
        const bool writes = root->glint_virtual__DOT__VexRiscv__DOT__lastStageRegFileWrite_valid;
        instructions.push_back({cycles, root->glint_virtual__DOT__VexRiscv__DOT__lastStagePc,
                                writes ? root->glint_virtual__DOT__VexRiscv__DOT__lastStageRegFileWrite_payload_address : 0u,
                                root->glint_virtual__DOT__VexRiscv__DOT__lastStageRegFileWrite_payload_data});
    }

    // Moves the image sensor's port by half a cycle of sys_clk. The levels of a period change at its beginning, PCLK rises in its middle.
    void move_camera() {
        if (camera_levels.empty()) return;
        camera_phase += camera_ticks;
        if (camera_phase < PIXEL_PERIOD) return;
        camera_phase -= PIXEL_PERIOD;
        const uint16_t levels = camera_levels.front();
        const bool inverted = levels & CAMERA_INVERTED;
        top.camera_d = levels & 0xff;
        top.camera_href = levels >> 8 & 1;
        top.camera_vsync = levels >> 9 & 1;
        top.camera_pclk = !(levels & CAMERA_STILL) && camera_second_half != inverted;
        if (camera_second_half) camera_levels.pop_front();
        camera_second_half = !camera_second_half;
    }

    // Outputs to devices that react to each edge, coded as for soc_outputs.
    uint8_t outputs() const {
        return top.i2c_scl_out | top.i2c_sda_out << 1 | top.camera_scl_out << 2 | top.camera_sda_out << 3 |
               top.camera_reset_n << 4 | top.camera_power_down << 5 | top.flash_cs_n << 6 | top.flash_clk << 7;
    }

    uint8_t i2c_wires() const {
        return i2c_released & outputs();
    }

    uint64_t run_to_edge(uint64_t count) {
        Verilated::threadContextp(&context);
        const uint8_t before = outputs();
        uint64_t done = 0;
        while (done < count && outputs() == before) {
            cycle();
            ++done;
        }
        return done;
    }

    void run(uint64_t count) {
        Verilated::threadContextp(&context);
        while (count--) cycle();
    }

    void run_bare(uint64_t count) {
        Verilated::threadContextp(&context);
        cycles += count;
        while (count--) {
            top.sys_clk = 1;
            top.pix_clk = 0;
            eval();
            top.sys_clk = 0;
            top.pix_clk = pixel_tick();
            eval();
        }
    }

    // Advances the phase of pix_clk by one cycle of sys_clk; returns whether pix_clk rises in that cycle.
    bool pixel_tick() {
        pixel_phase += PIXEL_TICKS;
        const bool tick = pixel_phase >= PIXEL_PERIOD;
        if (tick) pixel_phase -= PIXEL_PERIOD;
        return tick;
    }

    void rom_write(const uint8_t *bytes, size_t length) {
        auto &rom = top.rootp->glint_virtual__DOT__rom.m_storage;
        static_assert(sizeof rom == ROM_SIZE);
        std::memset(rom, 0, sizeof rom);
        std::memcpy(rom, bytes, std::min(length, sizeof rom));
    }

    // The contents of DDR3, in the order of their addresses.
    uint8_t *ddr() const {
        auto &memory = top.rootp->glint_virtual__DOT__ddr3.m_storage;
        static_assert(sizeof memory == MAIN_RAM_SIZE);
        return reinterpret_cast<uint8_t *>(memory);
    }

    // Invalidates both caches of the CPU; no line fill may be in progress (see soc_ddr_write).
    void drop_caches() {
        // The lowest bit of a tag is its valid bit.
#ifdef CONFIG_CPU_HAS_DCACHE
        for (auto &tag : top.rootp->glint_virtual__DOT__VexRiscv__DOT__dataCache_1__DOT__ways_0_tags.m_storage) tag = 0;
#endif
        for (auto &tag : top.rootp->glint_virtual__DOT__VexRiscv__DOT__IBusCachedPlugin_cache__DOT__ways_0_tags.m_storage) tag = 0;
    }

    bool filling() const {
#ifdef CONFIG_CPU_HAS_DCACHE
        if (top.rootp->glint_virtual__DOT__VexRiscv__DOT__dataCache_1__DOT__loader_valid) return true;
#endif
        return top.rootp->glint_virtual__DOT__VexRiscv__DOT__IBusCachedPlugin_cache__DOT__lineLoader_valid;
    }
};

#define INSTANCE Soc
#include "interface.h"

extern "C" {

uint32_t soc_build_id(void) { return BUILD_ID; }
uint32_t soc_clock_hz(void) { return CONFIG_CLOCK_FREQUENCY; }

void soc_run(Soc *soc, uint64_t cycles) { soc->run(cycles); }
void soc_run_bare(Soc *soc, uint64_t cycles) { soc->run_bare(cycles); }
uint64_t soc_cycles(const Soc *soc) { return soc->cycles; }

void soc_uart_write(Soc *soc, const uint8_t *bytes, size_t length) {
    soc->uart_in.insert(soc->uart_in.end(), bytes, bytes + length);
}
size_t soc_uart_queued(const Soc *soc) { return soc->uart_in.size(); }
size_t soc_uart_read(Soc *soc, uint8_t *bytes, size_t capacity) {
    const size_t count = std::min(capacity, soc->uart_out.size());
    const auto end = soc->uart_out.begin() + static_cast<ptrdiff_t>(count);
    std::copy(soc->uart_out.begin(), end, bytes);
    soc->uart_out.erase(soc->uart_out.begin(), end);
    return count;
}

void soc_i2c_drive(Soc *soc, uint8_t released) { soc->i2c_released = released & 3; }
uint8_t soc_i2c_wires(const Soc *soc) { return soc->i2c_wires(); }
uint8_t soc_outputs(const Soc *soc) { return soc->outputs(); }
uint64_t soc_run_to_edge(Soc *soc, uint64_t cycles) { return soc->run_to_edge(cycles); }

void soc_camera_drive(Soc *soc, uint8_t released) { soc->camera_released = released & 3; }
void soc_camera_send(Soc *soc, uint32_t frequency, const uint16_t *levels, size_t count) {
    soc->camera_ticks = frequency / CLOCK_UNIT;
    soc->camera_levels.insert(soc->camera_levels.end(), levels, levels + count);
}
size_t soc_camera_queued(const Soc *soc) { return soc->camera_levels.size(); }
void soc_camera_clear(Soc *soc) {
    soc->camera_levels.clear();
    soc->camera_second_half = false;
}
uint64_t soc_camera_clocks(const Soc *soc) { return soc->camera_clocks; }

void soc_video_record(Soc *soc, int on) { soc->video_on = on != 0; }
const uint32_t *soc_video_samples(const Soc *soc, size_t *count) {
    *count = soc->video.size();
    return soc->video.data();
}
void soc_video_clear(Soc *soc) { soc->video.clear(); }

void soc_flash_drive(Soc *soc, uint8_t lines) { soc->top.flash_dq_in = lines & FLASH_RELEASED; }
uint8_t soc_flash_lines(const Soc *soc) { return soc->top.flash_dq_out; }

void soc_instructions_record(Soc *soc, int on) { soc->instructions_on = on != 0; }
const SocInstruction *soc_instructions(const Soc *soc, size_t *count) {
    *count = soc->instructions.size();
    return soc->instructions.data();
}
void soc_instructions_clear(Soc *soc) { soc->instructions.clear(); }

int soc_filling(const Soc *soc) { return soc->filling(); }
void soc_ddr_read(Soc *soc, uint32_t offset, uint8_t *bytes, size_t length) {
    std::memcpy(bytes, soc->ddr() + offset, length);
}

void soc_ddr_write(Soc *soc, uint32_t offset, const uint8_t *bytes, size_t length) {
    std::memcpy(soc->ddr() + offset, bytes, length);
    soc->drop_caches();
}

void soc_rom_write(Soc *soc, const uint8_t *bytes, size_t length) { soc->rom_write(bytes, length); }

}  // extern "C"
