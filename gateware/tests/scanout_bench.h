// The world around the scan-out module: two clocks, a memory with chosen manners, software, and a monitor.
//
// The monitor knows the CEA-861 drawing and the rules of the picture, not the module: at each pixel clock it checks the
// syncs against a position counted from the first vsync edge, and at the end of each line that the line is the right
// one, or, where memory was late, the one before it. Everything is drawn from a fixed seed.

#pragma once

#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "verilated.h"

struct Raster {
    unsigned h_active, h_front, h_sync, h_back;
    unsigned v_active, v_front, v_sync, v_back;
    unsigned h_total() const { return h_active + h_front + h_sync + h_back; }
    unsigned v_total() const { return v_active + v_front + v_sync + v_back; }
};

// Frequencies in any common unit; only the ratio and the phase count.
struct Clocks {
    uint64_t sys, pix;
};

struct Failure {
    std::string text;
};

[[noreturn]] inline void fail(const char *format, ...) {
    char text[300];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    throw Failure{text};
}

// What software asks for and the hardware has in force.
struct Settings {
    bool enable = false;
    unsigned scale = 4;
    uint32_t base = 0; // in words of 16 bytes
    bool operator==(const Settings &) const = default;
};

// How memory behaves: the share of cycles in which it takes a command and delivers a word, and the latency in cycles.
struct Manners {
    double ready = 1.0;
    double deliver = 1.0;
    unsigned latency_min = 8, latency_max = 8;
    double pause = 0.0;      // chance in a cycle to stop altogether
    unsigned pause_cycles = 0; // for up to so long
};

// Memory holds noise: the pixel at a byte address is a hash of it, so every line of every frame is unlike all others.
inline uint16_t pixel_at(uint64_t address) {
    uint64_t z = address * 0x9E3779B97F4A7C15u + 0xD1B54A32D192ED03u;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return uint16_t(z ^ (z >> 31));
}

// 565 to 888: each channel repeats its bits, that is the first eight bits of value/31 or value/63 in binary.
inline uint32_t rgb888(uint16_t pixel) {
    const uint32_t r = pixel >> 11, g = pixel >> 5 & 63, b = pixel & 31;
    return (r * 33 >> 2) << 16 | (g * 65 >> 4) << 8 | b * 33 >> 2;
}

template <class Model>
class Bench {
public:
    Bench(const Raster &raster, Clocks clocks, uint64_t seed)
        : raster(raster), random(seed), sys_period(clocks.pix), pix_period(clocks.sys) {
        context.randReset(2); // registers start with noise, so that a missing reset shows
        context.randSeed(int(seed % 1000000007) + 1);
        model = std::make_unique<Model>(&context);
        next_sys = 1 + random() % sys_period;
        next_pix = 1 + random() % pix_period;
        model->sys_clk = model->pix_clk = 0;
        model->sys_rst = model->pix_rst = 1;
        drive();
        model->eval();
        for (int i = 0; i < 40; i++) edge();
        reset_sys(false);
        reset_pix(false);
    }

    ~Bench() { model->final(); }

    const Raster &raster;
    std::mt19937_64 random;
    Manners manners;
    Settings asked;            // what software wants; drives the inputs from the next sys edge on
    Settings in_force;         // as taken over at the last vblank
    bool lines_may_be_late = false;
    bool memory_stopped = false;
    uint64_t frames_seen = 0;  // by the monitor, with all lines
    uint64_t late = 0;         // source lines late by the picture
    uint64_t late_again = 0;   // of them, caught up within their group
    std::unique_ptr<Model> &top() { return model; }

    // Called at each sys cycle: random software.
    void (*software)(Bench &) = nullptr;

    void run_sys_cycles(uint64_t count) {
        for (const uint64_t end = sys_cycles + count; sys_cycles < end;) edge();
    }

    // Until the next vblank pulse has been seen.
    void run_to_vblank() {
        const uint64_t before = vblanks;
        const uint64_t limit = sys_cycles + 3ull * raster.h_total() * raster.v_total() * pix_period / sys_period + 1000;
        while (vblanks == before) {
            edge();
            if (sys_cycles > limit) fail("no vblank within three frames");
        }
    }

    void run_frames(unsigned count) {
        while (count--) run_to_vblank();
    }

    void reset_sys(bool on) {
        model->sys_rst = on;
        active_end = 0; // a vblank that falls into the reset is served after it
        if (!on) return;
        asked = in_force = {};
        drive();
        commands.clear();
        model->rdata_valid = 0;
        line_unchecked = true;
        line_shown.reset();
        counted = {};
        late = underflows_before = 0;
        held.reset();
        was_fetching = false;
        expected_error = 0;
    }

    void reset_pix(bool on) {
        model->pix_rst = on;
        if (!on) return;
        position.reset();
        line.clear();
        vsync_before = true;
        active_end = 0;
    }

private:
    struct Counted {
        uint32_t vblanks = 0, busy = 0, stalled = 0, words = 0;
    };
    struct Command {
        uint32_t address;
        uint64_t due;
    };

    VerilatedContext context;
    std::unique_ptr<Model> model;
    uint64_t sys_period, pix_period, next_sys, next_pix;
    uint64_t now = 0, sys_cycles = 0, vblanks = 0;

    Settings driven;

    // Memory.
    std::deque<Command> commands;
    std::optional<uint32_t> held; // address of a command that was not taken
    uint64_t paused_until = 0;
    Settings fetched_from; // the frame that the fetch under way belongs to
    bool was_fetching = false;
    Counted counted;
    unsigned expected_error = 0;
    uint64_t underflows_before = 0;

    // Monitor.
    std::optional<uint64_t> position; // pixel clocks since the leading edge of vsync
    bool vsync_before = true;
    std::vector<uint32_t> line;
    bool line_unchecked = false;
    std::optional<unsigned> line_shown; // source line last shown in this frame
    uint64_t active_end = 0; // time of the last pixel of the last line, until the vblank that follows

    bool chance(double p) { return p >= 1.0 || (p > 0.0 && double(random() >> 11) * 0x1p-53 < p); }

    void edge() {
        now = std::min(next_sys, next_pix);
        const bool sys = now == next_sys, pix = now == next_pix;
        if (sys) before_sys_edge();
        if (sys) model->sys_clk = 1;
        if (pix) model->pix_clk = 1;
        model->eval();
        if (sys) after_sys_edge();
        if (pix) watch();
        model->sys_clk = model->pix_clk = 0;
        model->eval();
        if (sys) next_sys += sys_period, sys_cycles++;
        if (pix) next_pix += pix_period;
    }

    void drive() {
        driven = asked;
        model->enable = asked.enable;
        model->scale = asked.scale;
        model->frame_base = asked.base;
    }

    // ---- Memory and software, in sys_clk ----

    void before_sys_edge() {
        if (model->sys_rst) return;
        if (model->fetching && !was_fetching) fetched_from = in_force;
        was_fetching = model->fetching;
        if (held && (!model->cmd_valid || model->cmd_addr != *held))
            fail("command 0x%x was changed or withdrawn before it was taken", *held);
        held.reset();
        if (model->cmd_valid && model->cmd_ready) {
            take(model->cmd_addr);
        } else if (model->cmd_valid) {
            held = model->cmd_addr;
            counted.stalled++;
        }
        counted.busy += model->fetching;
        counted.words += model->rdata_valid;
        if (model->vblank) at_vblank();
    }

    void take(uint32_t address) {
        const Settings &frame = fetched_from;
        const uint32_t words = raster.h_active / frame.scale * (raster.v_active / frame.scale) / 8;
        if (!frame.enable || address - frame.base >= words)
            fail("read of word 0x%x, outside the frame at 0x%x", address, frame.base);
        if (commands.size() >= raster.h_active / 8) fail("more commands under way than a line has words");
        const unsigned latency = manners.latency_min + random() % (manners.latency_max - manners.latency_min + 1);
        uint64_t due = sys_cycles + latency;
        if (!commands.empty()) due = std::max(due, commands.back().due); // in order
        commands.push_back({address, due});
    }

    void at_vblank() {
        vblanks++;
        counted.vblanks++;
        if (active_end != 0 && now - active_end > (raster.h_front + 8) * pix_period + 4 * sys_period)
            fail("vblank comes %llu pixels after the last pixel", (unsigned long long)((now - active_end) / pix_period));
        active_end = 0;
        const bool scale_known = driven.scale == 1 || driven.scale == 2 || driven.scale == 4;
        const unsigned scale = scale_known ? driven.scale : in_force.scale;
        in_force = driven;
        in_force.scale = scale;
        line_shown.reset();
        expected_error = !scale_known ? 1 : late != underflows_before ? 2 : 0;
        underflows_before = late;
        if (model->underflows != uint32_t(late))
            fail("%u underflows counted, the picture has %llu", model->underflows, (unsigned long long)late);
    }

    void after_sys_edge() {
        if (model->sys_rst) {
            model->rdata_valid = 0;
            model->cmd_ready = 0;
            return;
        }
        check_registers();
        if (software) software(*this);
        drive();

        if (sys_cycles >= paused_until && chance(manners.pause)) paused_until = sys_cycles + random() % manners.pause_cycles;
        const bool awake = sys_cycles >= paused_until && !memory_stopped;
        model->cmd_ready = awake && chance(manners.ready);
        model->rdata_valid = 0;
        if (awake && !commands.empty() && commands.front().due <= sys_cycles && chance(manners.deliver)) {
            const uint64_t byte = uint64_t(commands.front().address) * 16;
            commands.pop_front();
            for (int i = 0; i < 4; i++)
                model->rdata[i] = pixel_at(byte + 4 * i) | uint32_t(pixel_at(byte + 4 * i + 2)) << 16;
            model->rdata_valid = 1;
        } else {
            for (int i = 0; i < 4; i++) model->rdata[i] = uint32_t(random());
        }
    }

    void check_registers() {
        const auto same = [](const char *what, uint32_t got, uint32_t expected) {
            if (got != expected) fail("%s reads %u, expected %u", what, got, expected);
        };
        same("enabled", model->enabled, in_force.enable);
        same("scale_current", model->scale_current, in_force.scale);
        same("frame_current", model->frame_current, in_force.base);
        same("frames", model->frames, counted.vblanks);
        same("cycles_busy", model->cycles_busy, counted.busy);
        same("cycles_stalled", model->cycles_stalled, counted.stalled);
        same("items_in", model->items_in, counted.words);
        same("error", model->error, expected_error);
    }

    // ---- Monitor, in pix_clk ----

    void watch() {
        if (model->pix_rst) return;
        const bool vsync = model->video_vsync;
        const uint32_t rgb = uint32_t(model->video_r) << 16 | uint32_t(model->video_g) << 8 | model->video_b;
        if (!position) {
            if (vsync && !vsync_before) position = 0;
            vsync_before = vsync;
            if (!position) return;
        } else if (++*position == uint64_t(raster.h_total()) * raster.v_total()) {
            position = 0;
        }
        // A line begins with the leading edge of hsync, a frame with that of vsync.
        const unsigned x = *position % raster.h_total(), y = *position / raster.h_total();
        const unsigned left = raster.h_sync + raster.h_back, top = raster.v_sync + raster.v_back;
        const bool de = y >= top && y < top + raster.v_active && x >= left && x < left + raster.h_active;
        if (model->video_hsync != (x < raster.h_sync)) fail("hsync is %u at x %u, y %u", model->video_hsync, x, y);
        if (vsync != (y < raster.v_sync)) fail("vsync is %u at x %u, y %u", vsync, x, y);
        if (model->video_de != de) fail("de is %u at x %u, y %u", model->video_de, x, y);
        if (!de) {
            if (rgb != 0) fail("colour %06x in the blanking at x %u, y %u", rgb, x, y);
            return;
        }
        line.push_back(rgb);
        if (line.size() == raster.h_active) {
            check_line(y - top);
            line.clear();
        }
    }

    bool line_is(unsigned source_line) const {
        const unsigned width = raster.h_active / in_force.scale;
        const uint64_t start = uint64_t(in_force.base) * 16 + uint64_t(source_line) * width * 2;
        for (unsigned x = 0; x < raster.h_active; x++)
            if (line[x] != rgb888(pixel_at(start + x / in_force.scale * 2))) return false;
        return true;
    }

    bool line_is_black() const {
        for (const uint32_t pixel : line)
            if (pixel != 0) return false;
        return true;
    }

    void check_line(unsigned y) {
        if (y == raster.v_active - 1) active_end = now, frames_seen++;
        if (line_unchecked) { // a reset fell into it
            line_unchecked = false;
            return;
        }
        if (!in_force.enable) {
            if (!line_is_black()) fail("line %u is not black while disabled", y);
            return;
        }
        const unsigned needed = y / in_force.scale;
        const bool first_use = y % in_force.scale == 0;
        if (line_is(needed)) {
            if (!first_use && line_shown != needed) late_again++;
            line_shown = needed;
            return;
        }
        if (!lines_may_be_late) fail("line %u does not show source line %u (first pixel %06x)", y, needed, line[0]);
        if (first_use) late++;
        if (line_shown ? !line_is(*line_shown) : !line_is_black())
            fail("line %u shows neither source line %u nor the line before it", y, needed);
    }
};
