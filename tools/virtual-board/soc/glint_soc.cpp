// The harness around the verilated SoC. See glint_soc.h for the contract.

#include "glint_soc.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "Vglint.h"
#include "Vglint___024root.h"
#include "generated/mem.h"
#include "generated/soc.h"
#include "verilated.h"
#if VM_TRACE_VCD
#include "verilated_vcd_c.h"
#endif

// The BIOS, kept in the library so that it needs no file at run time.
asm(".section .rodata\n"
    ".balign 4\n"
    "glint_bios:\n"
    ".incbin \"" GLINT_BIOS "\"\n"
    "glint_bios_end:\n"
    ".previous\n");
extern "C" const uint8_t glint_bios[] __attribute__((visibility("hidden")));
extern "C" const uint8_t glint_bios_end[] __attribute__((visibility("hidden")));

namespace {

// pix_clk / sys_clk = 74.25 / 81.25.
constexpr uint32_t PIXEL_TICKS = 297;
constexpr uint32_t PIXEL_PERIOD = 325;

// Longer than any store takes to reach memory: an instruction fill and a refresh may come before it.
constexpr uint64_t SETTLE_CYCLES = 1000;

// LiteDRAM maps addresses ROW_BANK_COL: above the 16 bytes of a word come 7 bits of column, 3 of bank, 13 of row.
// A bank's memory is indexed by row and column.
constexpr size_t WORD_BYTES = 16;
constexpr size_t COLUMN_BITS = 7;
constexpr size_t BANK_BITS = 3;
constexpr size_t RUN_BYTES = WORD_BYTES << COLUMN_BITS;  // Contiguous bytes in one bank.

// Simulated time in units of 1 ps for waveforms.
constexpr uint64_t HALF_PERIOD_PS = 500'000'000'000ull / CONFIG_CLOCK_FREQUENCY;

// A context whose model runs in the caller's thread alone.
struct Context : VerilatedContext {
    Context() { threads(1); }
};

}  // namespace

struct glint_soc {
    Context context;
    Vglint top{&context, "soc"};
    uint64_t cycles = 0;
    uint32_t pixel_phase = 0;
    std::deque<uint8_t> uart_in;
    std::deque<uint8_t> uart_out;
    uint8_t i2c_released = 3;
    bool video_on = false;
    std::vector<uint32_t> video;
#if VM_TRACE_VCD
    std::unique_ptr<VerilatedVcdC> trace;
#endif

    glint_soc() {
        top.serial_source_ready = 1;
        top.i2c_scl_in = 1;
        top.i2c_sda_in = 1;
        rom_write(glint_bios, static_cast<size_t>(glint_bios_end - glint_bios));
    }

    ~glint_soc() {
#if VM_TRACE_VCD
        if (trace) trace->close();
#endif
        top.final();
        // A model leaves the thread's context when it is destroyed, not its own: another board's would be wrong.
        Verilated::threadContextp(&context);
    }

    void eval() {
        top.eval();
#if VM_TRACE_VCD
        if (trace) trace->dump(context.time());
#endif
        context.timeInc(HALF_PERIOD_PS);
    }

    void cycle() {
        // The rising edge of sys_clk takes what the pins show now.
        const bool sent = top.serial_source_valid;
        const uint8_t sent_byte = top.serial_source_data;
        const bool taken = top.serial_sink_valid && top.serial_sink_ready;
        top.sys_clk = 1;
        top.pix_clk = 0;
        eval();

        // Pins change between the edges. pix_clk rises at the falling edge of sys_clk, so two evaluations serve both.
        if (sent) uart_out.push_back(sent_byte);
        if (taken) uart_in.pop_front();
        top.serial_sink_valid = !uart_in.empty();
        if (!uart_in.empty()) top.serial_sink_data = uart_in.front();
        const uint8_t wires = i2c_wires();
        top.i2c_scl_in = wires & 1;
        top.i2c_sda_in = wires >> 1;
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

    uint8_t i2c_released_by_soc() const {
        return top.i2c_scl_out | top.i2c_sda_out << 1;
    }

    uint8_t i2c_wires() const {
        return i2c_released & i2c_released_by_soc();
    }

    uint64_t run_to_i2c(uint64_t count) {
        Verilated::threadContextp(&context);
        const uint8_t before = i2c_released_by_soc();
        uint64_t done = 0;
        while (done < count && i2c_released_by_soc() == before) {
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
            top.eval();
            top.sys_clk = 0;
            top.pix_clk = pixel_tick();
            top.eval();
        }
    }

    // Whether pix_clk rises in this cycle.
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

    // Calls `copy(memory, bytes, length)` for every run of bytes that is contiguous in a bank.
    template <typename Copy>
    void for_each_run(size_t offset, size_t length, Copy copy) {
        auto *root = top.rootp;
        const std::array banks = {
            &root->glint_virtual__DOT__ddr3_bank0, &root->glint_virtual__DOT__ddr3_bank1,
            &root->glint_virtual__DOT__ddr3_bank2, &root->glint_virtual__DOT__ddr3_bank3,
            &root->glint_virtual__DOT__ddr3_bank4, &root->glint_virtual__DOT__ddr3_bank5,
            &root->glint_virtual__DOT__ddr3_bank6, &root->glint_virtual__DOT__ddr3_bank7,
        };
        static_assert(banks.size() == 1 << BANK_BITS);
        static_assert(sizeof *banks[0] * banks.size() == MAIN_RAM_SIZE);
        size_t done = 0;
        while (done < length) {
            const size_t at = offset + done;
            const size_t bank = at / RUN_BYTES % banks.size();
            const size_t row = at / RUN_BYTES / banks.size();
            const size_t within = at % RUN_BYTES;
            const size_t count = std::min(length - done, RUN_BYTES - within);
            auto *memory = reinterpret_cast<uint8_t *>(banks[bank]->m_storage);
            copy(memory + row * RUN_BYTES + within, done, count);
            done += count;
        }
    }

    // Empties both caches of the CPU. Called when no line is being filled, or old data would arrive in a line
    // afterwards.
    void drop_caches() {
        // The lowest bit of a tag says that it is valid.
        for (auto &tag : top.rootp->glint_virtual__DOT__VexRiscv__DOT__dataCache_1__DOT__ways_0_tags.m_storage) tag = 0;
        for (auto &tag : top.rootp->glint_virtual__DOT__VexRiscv__DOT__IBusCachedPlugin_cache__DOT__ways_0_tags.m_storage) tag = 0;
    }

    // Lets stores that the CPU has made arrive in memory.
    void settle() {
        if (cycles > 0) run(SETTLE_CYCLES);
    }

    bool filling() const {
        return top.rootp->glint_virtual__DOT__VexRiscv__DOT__dataCache_1__DOT__loader_valid ||
               top.rootp->glint_virtual__DOT__VexRiscv__DOT__IBusCachedPlugin_cache__DOT__lineLoader_valid;
    }
};

extern "C" {

uint32_t glint_soc_abi(void) { return GLINT_SOC_ABI; }
uint32_t glint_soc_build_id(void) { return BUILD_ID; }
uint32_t glint_soc_clock_hz(void) { return CONFIG_CLOCK_FREQUENCY; }

glint_soc *glint_soc_new(void) { return new glint_soc; }
void glint_soc_free(glint_soc *soc) { delete soc; }

int glint_soc_trace(glint_soc *soc, const char *path) {
#if VM_TRACE_VCD
    soc->context.traceEverOn(true);
    soc->trace = std::make_unique<VerilatedVcdC>();
    soc->top.trace(soc->trace.get(), 99);
    soc->trace->open(path);
    return soc->trace->isOpen();
#else
    (void)soc, (void)path;
    return 0;
#endif
}

void glint_soc_run(glint_soc *soc, uint64_t cycles) { soc->run(cycles); }
void glint_soc_run_bare(glint_soc *soc, uint64_t cycles) { soc->run_bare(cycles); }
uint64_t glint_soc_cycles(const glint_soc *soc) { return soc->cycles; }

void glint_soc_uart_write(glint_soc *soc, const uint8_t *bytes, size_t length) {
    soc->uart_in.insert(soc->uart_in.end(), bytes, bytes + length);
}
size_t glint_soc_uart_queued(const glint_soc *soc) { return soc->uart_in.size(); }
size_t glint_soc_uart_read(glint_soc *soc, uint8_t *bytes, size_t capacity) {
    const size_t count = std::min(capacity, soc->uart_out.size());
    const auto end = soc->uart_out.begin() + static_cast<ptrdiff_t>(count);
    std::copy(soc->uart_out.begin(), end, bytes);
    soc->uart_out.erase(soc->uart_out.begin(), end);
    return count;
}

void glint_soc_set_buttons(glint_soc *soc, uint8_t pressed) { soc->top.buttons = pressed & 0xf; }
void glint_soc_set_switches(glint_soc *soc, uint16_t on) { soc->top.switches = on; }
uint16_t glint_soc_leds(const glint_soc *soc) { return soc->top.leds; }

void glint_soc_i2c_drive(glint_soc *soc, uint8_t released) { soc->i2c_released = released & 3; }
uint8_t glint_soc_i2c_wires(const glint_soc *soc) { return soc->i2c_wires(); }
uint8_t glint_soc_i2c_released(const glint_soc *soc) { return soc->i2c_released_by_soc(); }
uint64_t glint_soc_run_to_i2c(glint_soc *soc, uint64_t cycles) { return soc->run_to_i2c(cycles); }

void glint_soc_video_record(glint_soc *soc, int on) { soc->video_on = on != 0; }
const uint32_t *glint_soc_video_samples(const glint_soc *soc, size_t *count) {
    *count = soc->video.size();
    return soc->video.data();
}
void glint_soc_video_clear(glint_soc *soc) { soc->video.clear(); }

void glint_soc_ddr_read(glint_soc *soc, uint32_t offset, uint8_t *bytes, size_t length) {
    soc->settle();
    soc->for_each_run(offset, length, [bytes](const uint8_t *memory, size_t at, size_t count) {
        std::memcpy(bytes + at, memory, count);
    });
}

void glint_soc_ddr_write(glint_soc *soc, uint32_t offset, const uint8_t *bytes, size_t length) {
    soc->settle();
    while (soc->filling()) soc->cycle();
    soc->for_each_run(offset, length, [bytes](uint8_t *memory, size_t at, size_t count) {
        std::memcpy(memory, bytes + at, count);
    });
    soc->drop_caches();
}

void glint_soc_rom_write(glint_soc *soc, const uint8_t *bytes, size_t length) { soc->rom_write(bytes, length); }

}  // extern "C"
