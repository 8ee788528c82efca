// Tests of the scan-out module; scanout_bench.h says what each of them checks all the time.
//
// `Vscanout` is the module as built (CEA-861 1280x720). `Vscanout_small` has a raster of a few thousand clocks and as much
// time a line for its memory words, so that thousands of frames fit in a test.

#include <cstring>

#include "Vscanout.h"
#include "Vscanout_small.h"
#include "scanout_bench.h"

static const Raster CEA = {1280, 110, 40, 220, 720, 5, 5, 20};
static const Raster SMALL = {SMALL_RASTER};

static const Clocks SLOW = {8125, 7425}, FAST = {10000, 7425};

using Full = Bench<Vscanout>;
using Small = Bench<Vscanout_small>;

static void expect(bool condition, const char *what) {
    if (!condition) fail("expected %s", what);
}

static Settings random_settings(std::mt19937_64 &random) {
    Settings settings;
    settings.enable = random() % 8 != 0;
    settings.scale = 1u << random() % 3;
    settings.base = uint32_t(random() % 0x700000);
    return settings;
}

// Changes its mind at any time, several times a frame.
template <class B>
static void restless_software(B &bench) {
    if (bench.random() % 1500 == 0) bench.asked = random_settings(bench.random);
}

static const Manners BUSY = {.ready = 0.5, .deliver = 0.7, .latency_min = 5, .latency_max = 60};

// ---- The real raster ----

static void all_scales_pixel_exact(Clocks clocks) {
    Full bench(CEA, clocks, 1);
    bench.manners = BUSY;
    for (const unsigned scale : {4, 2, 1}) {
        bench.asked = {.enable = true, .scale = scale, .base = 0x123456 * scale};
        bench.run_to_vblank(); // takes it over
    }
    bench.run_to_vblank();
    expect(bench.late == 0, "no underflow");
    expect(bench.frames_seen == 3, "three frames");
    expect(bench.top()->items_out == 180 + 360 + 720, "as many lines fetched as the frames have");
    expect(bench.top()->items_in == 180 * 40 + 360 * 80 + 720 * 160, "each word read once");
}

// ---- The small raster ----

static void flips_and_switches_at_any_time() {
    const Clocks ratios[] = {SLOW, FAST, {7425, 7425}, {7426, 7425}, {20000, 7425}, {7425, 11000}, {15000, 7425}};
    uint64_t seed = 100;
    for (const Clocks clocks : ratios) {
        Small bench(SMALL, clocks, seed++);
        bench.manners = {.ready = 0.8, .deliver = 0.9, .latency_min = 2, .latency_max = 20};
        bench.software = restless_software<Small>;
        bench.run_frames(60);
        expect(bench.late == 0, "no underflow");
    }
}

static void a_late_line_is_replaced_by_the_one_before() {
    for (const unsigned scale : {1, 2, 4}) {
        Small bench(SMALL, SLOW, 200 + scale);
        bench.asked = {.enable = true, .scale = scale, .base = 0x100};
        bench.run_frames(2);
        bench.lines_may_be_late = true;
        // Into the picture, then no memory for twice the time that a source line has.
        const uint64_t line_cycles = SMALL.h_total() * SLOW.sys / SLOW.pix;
        bench.run_sys_cycles((SMALL.v_front + SMALL.v_sync + SMALL.v_back + 9) * line_cycles);
        bench.memory_stopped = true;
        bench.run_sys_cycles(2 * scale * line_cycles);
        bench.memory_stopped = false;
        bench.run_to_vblank();
        if (bench.late < 1 || bench.late > 3) fail("scale %u: %d late lines, expected one to three", scale, int(bench.late));
        if (scale == 4) expect(bench.late_again >= 1, "the late line to be shown in what is left of its time");
        expect(bench.top()->error == 2 || bench.late == 0, "the error code of an underflow");
        bench.lines_may_be_late = false;
        bench.run_frames(2);
        expect(bench.top()->error == 0, "the error to be gone with the next frame");
    }
}

static void starved_memory_never_disturbs_the_raster() {
    uint64_t late = 0, again = 0;
    for (uint64_t seed = 300; seed < 312; seed++) {
        Small bench(SMALL, seed & 1 ? SLOW : FAST, seed);
        bench.lines_may_be_late = true;
        // From lines to whole frames without memory.
        bench.manners = {.ready = 0.6, .deliver = 0.6, .latency_min = 2, .latency_max = 150,
                         .pause = 0.0005, .pause_cycles = seed % 3 == 0 ? 20000u : 1500u};
        bench.software = restless_software<Small>;
        bench.run_frames(60);
        late += bench.late;
        again += bench.late_again;
    }
    expect(late > 500 && again > 20, "many underflows, some caught up");
}

static void dead_memory_shows_black_and_comes_back() {
    Small bench(SMALL, SLOW, 400);
    bench.memory_stopped = true;
    bench.asked = {.enable = true, .scale = 2, .base = 0x4000};
    bench.run_to_vblank();
    bench.lines_may_be_late = true;
    bench.run_frames(3);
    expect(bench.late == 3 * SMALL.v_active / 2, "every source line of three frames late");
    // What comes now was asked for three frames ago, and for another base.
    bench.asked.base = 0x8000;
    bench.run_to_vblank();
    bench.memory_stopped = false;
    bench.lines_may_be_late = false;
    const uint64_t late = bench.late;
    bench.run_frames(2);
    expect(bench.late == late, "no underflow after memory has come back in the blanking");
}

static void scales_that_do_not_exist_are_refused() {
    Small bench(SMALL, SLOW, 500);
    bench.asked = {.enable = true, .scale = 2, .base = 0x77};
    bench.run_frames(2);
    for (const unsigned scale : {0, 3, 5, 6, 7}) {
        bench.asked.scale = scale;
        bench.run_frames(2);
        expect(bench.top()->error == 1 && bench.top()->scale_current == 2, "error 1 and the scale unchanged");
    }
}

static void either_side_may_be_reset_alone() {
    Small bench(SMALL, FAST, 600);
    bench.manners = {.ready = 0.8, .deliver = 0.9, .latency_min = 2, .latency_max = 20};
    const uint64_t frame_cycles = uint64_t(SMALL.h_total()) * SMALL.v_total() * FAST.sys / FAST.pix;
    for (int round = 0; round < 200; round++) {
        const Settings settings = {.enable = true, .scale = 1u << round % 3, .base = 0x1000u * round};
        bench.asked = settings;
        bench.run_frames(2);
        bench.run_sys_cycles(bench.random() % frame_cycles);
        // The raster goes on while sys alone is reset: the monitor keeps its position.
        if (round % 2 == 0) bench.reset_sys(true);
        if (round % 4 != 0) bench.reset_pix(true);
        bench.run_sys_cycles(8 + bench.random() % 3000);
        bench.reset_sys(false);
        bench.reset_pix(false);
        bench.run_sys_cycles(20); // a processor needs longer to set anything
    }
    bench.asked.enable = true;
    bench.run_frames(3);
    expect(bench.late == 0, "no underflow");
}

static void a_fetch_may_outlive_who_asked_for_it() {
    Small bench(SMALL, SLOW, 700);
    bench.asked = {.enable = true, .scale = 1, .base = 0x300};
    bench.run_frames(2);
    const uint64_t line_cycles = SMALL.h_total() * SLOW.sys / SLOW.pix;
    bench.run_sys_cycles((SMALL.v_front + SMALL.v_sync + SMALL.v_back + 9) * line_cycles);
    bench.memory_stopped = true;
    while (!bench.top()->fetching) bench.run_sys_cycles(1);
    bench.reset_pix(true);
    bench.run_sys_cycles(20);
    bench.reset_pix(false);
    bench.run_to_vblank();
    bench.run_sys_cycles(2 * line_cycles); // line 0 is asked for while the old line is still under way
    bench.memory_stopped = false;
    bench.run_frames(2);
    expect(bench.late == 0, "no underflow");
}

struct Test {
    const char *name;
    void (*run)();
};

static const Test TESTS[] = {
    {"all scales pixel-exact at 81.25 MHz", [] { all_scales_pixel_exact(SLOW); }},
    {"all scales pixel-exact at 100 MHz", [] { all_scales_pixel_exact(FAST); }},
    {"flips and switches at any time, seven clock ratios", flips_and_switches_at_any_time},
    {"a late line is replaced by the one before", a_late_line_is_replaced_by_the_one_before},
    {"starved memory never disturbs the raster", starved_memory_never_disturbs_the_raster},
    {"dead memory shows black and comes back", dead_memory_shows_black_and_comes_back},
    {"scales that do not exist are refused", scales_that_do_not_exist_are_refused},
    {"either side may be reset alone", either_side_may_be_reset_alone},
    {"a fetch may outlive who asked for it", a_fetch_may_outlive_who_asked_for_it},
};

int main(int argc, char **argv) {
    int failures = 0;
    for (const Test &test : TESTS) {
        if (argc > 1 && !strstr(test.name, argv[1])) continue;
        try {
            test.run();
            printf("ok    scanout: %s\n", test.name);
        } catch (const Failure &failure) {
            printf("FAIL  scanout: %s: %s\n", test.name, failure.text.c_str());
            failures++;
        }
        fflush(stdout);
    }
    return failures != 0;
}
