"""Mutations: textual changes of modules, each with the property that must detect it."""

from dataclasses import dataclass
from functools import partial


@dataclass(frozen=True)
class Mutation:
    """Replacement of the only occurrence of `old` in the file `source` by `new`. The property `fails`, given as its path within
    the proof, must then fail."""

    source: str
    old: str
    new: str
    fails: str


_skid = partial(Mutation, "skid_buffer.sv")
_fifo = partial(Mutation, "fifo.sv")
_crossing = partial(Mutation, "cdc_fifo.sv")
_capture = partial(Mutation, "camera_capture.sv")
_queue = partial(Mutation, "pipeline_fifo.sv")
_held = partial(Mutation, "held_register.sv")
_flush = partial(Mutation, "band_flush.sv")
_read = partial(Mutation, "read_port.sv")
_write = partial(Mutation, "write_port.sv")
_extents = partial(Mutation, "band_extents.sv")
_pipe = partial(Mutation, "band_pipe.sv")
_cull = partial(Mutation, "cull.sv")
_classify = partial(Mutation, "classify.sv")
_line_setup = partial(Mutation, "line_setup.sv")
_line_raster = partial(Mutation, "line_raster.sv")
_setup = partial(Mutation, "setup.sv")
_entry = partial(Mutation, "band_entry.sv")
_walker = partial(Mutation, "walker.sv")
_lanes = partial(Mutation, "lanes.sv")
_credit = partial(Mutation, "credit_fifo.sv")
_generator = partial(Mutation, "ray_generator.sv")
_pixels = partial(Mutation, "ray_pixels.sv")
_start = partial(Mutation, "exit_start.sv")
_smooth = partial(Mutation, "smooth_shader.sv")
_steps = partial(Mutation, "texture_queue.sv")
_fog = partial(Mutation, "group_fog.sv")
_cpu_bus = partial(Mutation, "cpu_bus.py")
_crossbar = partial(Mutation, "memory_crossbar.py")
_axi = partial(Mutation, "axi_ports.py")
_wishbone = partial(Mutation, "wishbone_ports.py")
_multiplexer = partial(Mutation, "memory_multiplexer.py")
_paint = partial(Mutation, "ray_paint.sv")
_ring = partial(Mutation, "ring_lane.sv")
_shadow = partial(Mutation, "exit_shadow.sv")
_exits = partial(Mutation, "exit_lane.sv")

_FIFO = [
    _fifo("DIRECT || stored ||", "DIRECT || stored && in_valid ||", "order.shown_in_time"),
    _fifo("load     = !read_valid || read_ready", "load     = !read_valid || read_ready || stored", "shown.payload_stable"),
    _fifo("stored || read_valid && !read_ready;", "stored;", "shown.valid_stays"),
    _fifo("DIRECT || stored ||", "DIRECT || stored || in_valid ||", "order.nothing_made_up"),
    _fifo("head != {~tail[PLACE_BITS], tail[PLACE_BITS-1:0]}", "1'b1", "order.nothing_too_many"),
    _fifo("'(load && stored)", "'(load && stored && !in_valid)", "order.in_order"),
    _fifo("'(in_valid && in_ready)", "'(in_valid)", "order.in_order"),
    _fifo("head != {~tail[PLACE_BITS], tail[PLACE_BITS-1:0]}", "head == '0", "order.taken_in_time"),
]

_DIRECT = [
    _fifo("DIRECT ? stored", "DIRECT ? stored && in_valid", "order.shown_in_time"),
    _fifo("load     = !read_valid || read_ready", "load     = !read_valid || read_ready || stored", "shown.payload_stable"),
    _fifo("DIRECT ? stored", "DIRECT ? stored && !in_valid", "shown.valid_stays"),
    _fifo("DIRECT ? stored", "DIRECT ? stored || in_valid", "order.nothing_made_up"),
]

_CREDIT = [
    _credit("next > COUNT_BITS'(1)", "next != '0", "order.nothing_too_many"),
    _credit("gave    <= out_valid && out_ready;", "gave    <= out_valid && out_ready && !sent;", "order.taken_in_time"),
    _fifo("'(load && stored)", "'(load && stored && !in_valid)", "order.in_order"),
]

_PAUSE = [
    _fifo("load     = !read_valid || read_ready", "load     = !read_valid || read_ready || stored", "shown.payload_stable"),
    _fifo("PAUSE ? read_valid && !read_ready :", "PAUSE ? read_valid && !out_valid :", "shown.valid_stays"),
]

MUTATIONS = {
    "skid_buffer": [
        _skid("in_valid || !in_ready ||", "in_valid && in_ready ||", "order.shown_in_time"),
        _skid("in_valid || !in_ready ||", "1'b1 ||", "order.nothing_made_up"),
        _skid("if (in_ready) spare", "spare", "order.in_order"),
        _skid("in_ready ? in_data : spare", "in_data", "order.in_order"),
        _skid("in_ready && !in_valid;", "in_ready;", "order.nothing_too_many"),
        _skid("!in_ready || !out_ready && out_valid;", "!in_ready;", "shown.valid_stays"),
        _skid("if (!out_valid || out_ready)", "if (!out_valid || out_ready || in_valid)", "shown.payload_stable"),
        _skid("!out_valid || out_ready || in_ready", "!out_valid || in_ready", "order.taken_in_time"),
    ],
    "fifo of 2": _FIFO,
    "fifo of 4": _FIFO,
    "fifo without register": [*_DIRECT, *_FIFO[4:]],
    "fifo in block RAM": [
        _FIFO[0],
        *_FIFO[3:],
        _fifo("load     = !read_valid || read_ready", "load     = !read_valid || read_ready || stored", "order.in_order"),
        _fifo(": !out_valid || out_ready;", ": !out_valid || out_ready || read_valid;", "shown.payload_stable"),
        _fifo(": read_valid || out_valid && !out_ready)", ": read_valid)", "shown.valid_stays"),
    ],
    "fifo with pauses": [
        _FIFO[0],
        *_FIFO[3:],
        *_PAUSE,
    ],
    "credit_fifo": [*_FIFO[:4], *_CREDIT],
    "credit_fifo without register": [*_DIRECT, *_CREDIT],
    "ray_generator": [
        _generator("assign out_valid  = kept_valid;", "assign out_valid  = kept_valid && walking;", "shown.valid_stays"),
        _fifo("!read_valid || read_ready;", "!read_valid || read_ready || stored;", "shown.payload_stable"),
        _start("out_valid = valid[LAST];", "out_valid = valid[LAST] || valid[LAST-1];", "nothing_made_up"),
        _credit("next > COUNT_BITS'(1)", "1'b1", "in_order"),
        _pixels("valid     = running && credit;", "valid     = running;", "in_order"),
        _generator("walking || !empty;", "walking;", "busy_to_the_end"),
        _generator("walking || !empty;", "walking || !empty || !start;", "idle_afterwards"),
        _start("out_valid = valid[LAST];", "out_valid = valid[LAST] && in_valid;", "shown_in_time"),
    ],
    "ray_paint": [
        _fifo("stored || read_valid && !read_ready;", "stored;", "shown.valid_stays"),
        _fifo("!read_valid || read_ready;", "!read_valid || read_ready || stored;", "shown.payload_stable"),
        _paint("in_valid && in_ready};", "in_valid};", "nothing_made_up"),
        _paint("CLOCKS(26 - BEGIN)) place_waits", "CLOCKS(25 - BEGIN)) place_waits", "in_order"),
        _credit("next > COUNT_BITS'(1)", "next != '0", "nothing_too_many"),
        _paint("valid <= {valid", "if (in_valid) valid <= {valid", "shown_in_time"),
        _credit("gave    <= out_valid && out_ready;", "gave    <= out_valid && out_ready && !sent;", "taken_in_time"),
    ],
    "band_flush": [
        _flush(".out_valid, .out_ready,", ".out_valid, .out_ready(1'b1),", "words.valid_stays"),
        _flush(".out_valid, .out_ready,", ".out_valid, .out_ready(1'b1),", "words.payload_stable"),
        _flush("depth_words_base <= depth_base;", "depth_words_base <= base;", "in_their_places"),
        _flush("{place_0, 1'b1}", "{place_0, 1'b0}", "in_their_places"),
        _flush("address   <= address_2;", "address   <= address_1;", "in_their_places"),
        # Fault: a span begins where the previous span ended instead of at its own first row.
        _flush("if (!paired) row <= span_first;", "if (!paired) row <= row + 1'b1;", "in_their_places"),
        # Fault: the flush admits more words than fit the FIFO.
        _flush("in_span && places != '0 && (", "in_span && (", "words_in_order"),
        # Fault: the flush clears a row before it reads the row's depth.
        _flush("clears <= part == last_part;", "clears <= 1'b1;", "words_in_order"),
        _flush("{18{written[lane]}}", "18'b0", "words_in_order"),
        # Fault: the flush takes a colour of the sky for each word of depths, too.
        _flush("takes_sky && part == COLOUR && word_ends;", "takes_sky && word_ends;", "sky_in_time"),
        _flush("takes_sky ? sky_colour : clear_colours}", "sky_colour}", "words_in_order"),
        _flush("|| sky_valid);", "|| 1'b1);", "sky_in_time"),
        _flush("&& row == last_row &&", "&& row == '1 &&", "none_made_up"),
        _flush("if (part_ends)               row <= first_row;", "if (part_ends) row <= row;", "none_left_out"),
        _flush("COLOUR:     if (part_ends && depth_too)", "COLOUR: if (depth_too)", "colour_first"),
        _flush("if (taken && !asked) ", "if (out_valid && !asked) ", "all_taken"),
        _flush("last_row  <= span_last;", "last_row  <= span_first;", "none_left_out"),
        # Fault: the flush ends during a span, or before the last span has come.
        _flush("if (!in_span && !spans_busy)", "if (!spans_busy)", "none_left_out"),
        _flush("if (!in_span && !spans_busy)", "if (!in_span && !span_valid)", "none_left_out"),
        _flush("(!in_span || span_ends);", "span_ends;", "no_standstill"),
        _flush("places <= places + 1'b1;", "places <= places;", "ends"),
        _flush("if (row == '1) state", "if (row == '1 && idle) state", "sweep_ends"),
        # Fault: a restart waits until memory has taken the words.
        _flush("SWEEP: begin", "SWEEP: if (places == COUNT_BITS'(WORDS)) begin", "sweep_ends"),
        # Fault: a restart begins its sweep at the row that the flush had reached instead of at row 0.
        _flush("state  <= SWEEP;\n            row    <= '0;", "state  <= SWEEP;", "all_swept"),
        _flush("clears <= part == last_part;", "clears <= part == last_part && row != last_row;", "cleared_behind"),
        _flush("clear_row <= row;", "clear_row <= row + 1'b1;", "cleared_behind"),
    ],
    "band_flush of averages": [
        # Fault: the threshold of a pixel depends on its column alone.
        _flush("odd <= !odd;", "odd <= odd;", "words_in_order"),
        _flush("colour_pkg::average(pair, previous, t0[i])", "colour_pkg::average(pair, pair, t0[i])", "words_in_order"),
        # Fault: both halves of a word are those of its first two rows.
        _flush("is_left  <= corner_word == 2'd1;", "is_left  <= corner_word == 2'd3;", "words_in_order"),
        # Fault: the lower row of a word is read in the line of the upper row.
        _flush("corner[0] ? back : down", "1'b1", "words_in_order"),
        _flush("(span_ends ? ROW_BITS'(gap) : '0)", "ROW_BITS'(0)", "in_their_places"),
        _flush(".in(address), .out(address_sums)", ".in(address_2), .out(address_sums)", "in_their_places"),
        # Fault: the flush begins after the first line of a pair.
        _flush("&& (!averaging || paired);", ";", "words_in_order"),
        _flush("if (!paired) row <= span_first;", "row <= span_first;", "words_in_order"),
        # Fault: a colour of the sky serves one row, not a whole word.
        _flush("takes_sky && part == COLOUR && word_ends;", "takes_sky && part == COLOUR;", "words_in_order"),
        _flush("{sky_line[0], corner[0]}", "sky_line", "words_in_order"),
        # Fault: each row of a word reserves a FIFO entry.
        _flush("assign asked = issue && word_ends;", "assign asked = issue;", "no_standstill"),
        _flush("places <= places + 1'b1;", "places <= places;", "ends"),
        _flush(".out_valid, .out_ready,", ".out_valid, .out_ready(1'b1),", "words.valid_stays"),
        _flush(".out_valid, .out_ready,", ".out_valid, .out_ready(1'b1),", "words.payload_stable"),
        _flush("if (taken && !asked) ", "if (out_valid && !asked) ", "all_taken"),
        _flush("if (!in_span && !spans_busy)", "if (!spans_busy)", "none_left_out"),
        _flush("|| sky_valid);", "|| 1'b1);", "sky_in_time"),
        _flush("asked_0 <= issue && word_ends;", "asked_0 <= issue;", "none_made_up"),
        _flush("clears <= part == last_part;", "clears <= part == last_part && word_ends;", "cleared_behind"),
    ],
    "ring_lane": [
        _ring("again || enter}", "again || in_valid}", "none_made_up"),
        _ring("if (!again) begin", "if (!again || in_valid) begin", "none_twice"),
        _ring("SLOT_BITS'(SLOTS - 1)", "SLOT_BITS'(SLOTS - 2)", "none_made_up"),
        _ring("assign in_ready = !again && places", "assign in_ready = places", "none_lost"),
        _ring("!again && places != '0;", "!again;", "no_more_than_fit"),
        _ring("occupied[LAST] && finished;", "occupied[LAST] && finished && !in_valid;", "none_lost"),
        _ring("finished   <= is_last_next && (beyond || near_next || late_next);", "finished   <= is_last_next && (beyond || near_next);", "none_lost"),
        _ring("enter ? places - 1'b1 : places + 1'b1", "enter ? places - 1'b1 : places", "empty_takes"),
        _ring("places   <= COUNT_BITS'(PLACES);", "places   <= '0;", "takes_again"),
        _ring("in_ray.place, in_ray.height,", "in_ray.place, ~in_ray.height,", "as_it_came"),
        _ring("steps_now + 10'd1 >= tuning.cap", "steps_now >= tuning.cap", "counts_steps"),
        _fifo("stored || read_valid && !read_ready;", "stored;", "ends.valid_stays"),
        _fifo("load     = !read_valid || read_ready", "load     = !read_valid || read_ready || stored", "ends.payload_stable"),
    ],
    "exit_lane": [
        _exits("again || enter}", "again || in_valid}", "none_made_up"),
        _exits("if (!again) cargos", "if (!again || in_valid) cargos", "none_twice"),
        _exits("assign in_ready = !again && places", "assign in_ready = places", "none_lost"),
        _exits("!again && places != '0;\n    assign enter", "!again;\n    assign enter", "no_more_than_fit"),
        _exits("occupied[LAST] && finished;", "occupied[LAST] && finished && !in_valid;", "none_lost"),
        _exits("= over_22 || hit_22 || left_22;", "= over_22 || left_22;", "none_lost"),
        _exits("enter ? places - 1'b1 : places + 1'b1", "enter ? places - 1'b1 : places", "empty_takes"),
        _exits("places   <= COUNT_BITS'(PLACES);", "places   <= '0;", "takes_again"),
        _exits("slot_21 <= following(slot_21);", "slot_21 <= following(slot_12);", "limit_in_step"),
        _exits("= sphere_22.met;", "= sphere_22.number[0];", "sphere_in_step"),
        _exits("states[slot_0] <=", "states[slot_22] <=", "start_in_step"),
        _exits("reached[slot_8])", "reached[slot_12])", "tag_in_step"),
        _exits("followed[slot_12] <=", "followed[slot_13] <=", "tag_in_step"),
        _exits("+ 8'(again || !in_ray.over);", "+ 8'd1;", "counts_steps"),
        _fifo("stored || read_valid && !read_ready;", "stored;", "ends.valid_stays"),
        _fifo("load     = !read_valid || read_ready", "load     = !read_valid || read_ready || stored", "ends.payload_stable"),
    ],
    "exit_shadow": [
        _shadow("in_end.hit && !in_end.round", "in_end.hit", "in_the_shade"),
        _shadow("= wants ? lane_ready : pass_ready", "= lane_ready && pass_ready", "none_twice"),
        _shadow(".in_valid(in_valid && !wants)", ".in_valid(in_valid)", "none_twice"),
        _shadow("found_valid || passed_valid", "found_valid || passed_valid || in_valid", "none_made_up"),
        _shadow(".in_data(in_end[KEPT_BITS-1:0])", ".in_data(in_end[KEPT_BITS-1:0] ^ KEPT_BITS'(1 << 16))", "none_changed"),
        _shadow("= found_valid || passed_valid", "= is_found ? found_valid : passed_valid && !found_valid", "ends.valid_stays"),
        _shadow("stays ? was_found : found_valid", "found_valid", "ends.payload_stable"),
        _shadow(".out_ready(out_ready && !is_found)", ".out_ready(out_ready)", "none_lost"),
        _shadow("is_found && found.hit}", "is_found}", "in_the_shade"),
        _shadow("if (is_found || ending.hit)", "if (is_found)", "in_the_shade"),
        _shadow("assign out_valid = found_valid || passed_valid", "assign out_valid = found_valid", "none_lost"),
    ],
    "read_port": [
        _skid("!in_ready || !out_ready && out_valid;", "!in_ready;", "commands.valid_stays"),
        _skid("if (!out_valid || out_ready)", "if (!out_valid || out_ready || in_valid)", "commands.payload_stable"),
        _read(".in_data(ask_addr[turn *", ".in_data(ask_addr[chosen *", "second.commands_in_order"),
        _read("(commands && moves) owners[asked[OWNER_BITS-1:0]] <= turn;", "(commands && moves) owners[asked[OWNER_BITS-1:0]] <= chosen;",
              "first.words_in_order"),
        # Fault: a word that comes while `drop` falls is stored.
        _read(" && !drop && !rst;", " && !rst;", "second.words_in_order"),
        _read("'(rdata_valid);", "'(rdata_valid && !drop);", "idle_is_answered"),
        _read(".rst       (rst || drop)", ".rst       (rst)", "second.none_after_drop"),
        _read("room[0] && !has_turn", "room[0]", "second.places_suffice"),
        _fifo("DIRECT || stored ||", "DIRECT || stored && in_valid ||", "second.shown_in_time"),
        _read("given <= any;", "given <= any && cmd_valid;", "first.taken_in_time"),
    ],
    "write_port": [
        _write("(cmd_ready && bursting)", "(cmd_ready)", "commands_in_order"),
        # Fault: a burst ends while a command waits.
        _write("|| bursting && gathered != '0;", ";", "commands.valid_stays"),
        _write("(cmd_ready && bursting)", "(bursting)", "commands.payload_stable"),
        _write("(cmd_ready && bursting)", "(bursting)", "commands_in_order"),
        # Fault: the port accepts a word while the FIFO of the data is full.
        _write("waiting_next < COUNT_BITS'(DEPTH)", "waiting_next < COUNT_BITS'(DEPTH + 2)", "data_in_order"),
        _write(".in_data   ({in_strobe, in_data})", ".in_data   ({in_strobe, in_data << 1})", "data_in_order"),
        _write("(move),\n        .in_ready  (),\n        .in_data   ({", "(move && gone),\n        .in_ready  (),\n        .in_data   ({",
               "data_at_command"),
        _write(".out_ready (wdata_ready)", ".out_ready (1'b1)", "data_at_command"),
        _write("(move),\n        .in_ready  (),\n        .in_data   ({", "(1'b1),\n        .in_ready  (),\n        .in_data   ({",
               "none_made_up"),
        _write("(move == gone ? '0 : move ?", "(move == gone ? '0 : move && !hurry ?", "idle_is_empty"),
        _write("|| hurry ||", "||", "goes_in_a_hurry"),
        _write("gathered >= COUNT_BITS'(BURST) || hurry", "hurry", "full_goes"),
    ],
    "band_extents": [
        _skid("!in_ready || !out_ready && out_valid;", "!in_ready;", "spans.valid_stays"),
        _skid("if (!out_valid || out_ready)", "if (!out_valid || out_ready || in_valid)",
                 "spans.payload_stable"),
        # Fault: the module ignores a line's extent in the last frame, or takes it from the other frame buffer.
        _extents("united(earlier, now_3);", "now_3;", "in_order"),
        _extents("to       <= from;", "to       <= {1'b0, from[PLACE_BITS-2:0]};", "in_order"),
        # Fault: the module continues to further lines while no span is taken.
        _extents("        if (advance) begin", "        if (1'b1) begin", "none_left_out"),
        # Fault: an extent stays after a sweep or for the next band, or keeps only its last group.
        _extents("sweeps_2 ? EMPTY : united", "united", "in_order"),
        _extents("empties_2 ? EMPTY : updated", "updated", "in_order"),
        _extents("united(old, {column_2, column_2})", "{column_2, column_2}", "in_order"),
        # Fault: two successive groups of a line update the same old extent.
        _extents("same[drawn_1] ? updated : kept[drawn_1]", "kept[drawn_1]", "in_order"),
        _extents("if (valid[4]) line_row", "line_row", "in_order"),
        _extents("all ? {last_column, {COLUMN_BITS{1'b0}}} : united", "united", "in_order"),
        _extents(" && united_4[COLUMN_BITS-1:0] != '1", "", "nothing_made_up"),
        _extents("busy      = planning || valid != '0 || span_valid;", "busy      = planning || span_valid;", "none_left_out"),
        _extents("valid    <= {valid[3:1], planning};", "valid    <= {valid[3:1], 1'b0};", "no_standstill"),
        _extents("if (line == last_line) planning", "if (line == last_line && span_valid) planning", "ends"),
    ],
    "band_pipe": [
        _pipe("hold <= 3'b111;", "hold <= 3'b011;", "drawn_as_given"),
        _pipe("hold <= 3'b011;", "hold <= 3'b001;", "drawn_as_given"),
        _pipe("            else if (conflict_1) hold <= 3'b001;\n", "", "drawn_as_given"),
        _pipe("comparing.codes[18*lane +: 18] >=", "comparing.codes[18*lane +: 18] >", "drawn_as_given"),
        _pipe("!stored_written[lane] ||", "", "drawn_as_given"),
        _pipe("hold <= hold >> 1;", "hold <= hold;", "taken_in_time"),
    ],
    "band_pipe with blended pixels": [
        _pipe("hold <= 3'b111;", "hold <= 3'b011;", "drawn_as_given"),
        # Fault: a blended pixel writes its depth, or the depth of a new pixel is not 0.
        _pipe("blended[3] ? compared.mask & ~stored_written", "blended[3] ? compared.mask", "drawn_as_given"),
        _pipe(".zero(blended[2])", ".zero(1'b0)", "drawn_as_given"),
        _pipe("write_lanes  = blended[3] ? compared.mask : asks[3] ? '0 : passing;", "write_lanes  = blended[3] ? compared.mask : passing;",
              "drawn_as_given"),
        _pipe("write_lanes  = blended[3] ? compared.mask :", "write_lanes  = blended[3] ? passing :", "drawn_as_given"),
        # Fault: the answer ignores the depth, or belongs to another group.
        _pipe("answer_lanes <= passing;", "answer_lanes <= compared.mask;", "drawn_as_given"),
        _pipe("answer_valid <= asks[3] &&", "answer_valid <= asks[2] &&", "drawn_as_given"),
        _pipe("if (!held) {asks[0]", "{asks[0]", "drawn_as_given"),
        _pipe("hold <= hold >> 1;", "hold <= hold;", "taken_in_time"),
    ],
    "cull": [
        _cull("room && !again;", "room && !again && out_ready;", "taken_in_time"),
        _cull("again   = first_valid && tall && !second;", "again   = first_valid && tall;", "leaves_in_time"),
        _cull("phase == 2'd1 && room && !again;", "phase == 2'd1 && !again;", "nothing_too_many"),
        _cull("first_valid && !again;", "first_valid;", "nothing_made_up"),
        _cull("verdict && drop || skip;", "drop || skip;", "nothing_made_up"),
        _cull("verdict && !drop;", "verdict;", "nothing_made_up"),
        _cull("!covers && !verdict;", "!covers;", "busy_while_inside"),
        _cull("room && !again;", "room;", "busy_while_inside"),
        _cull("first_valid || last_valid || !queue_idle;", "first_valid || last_valid;", "busy_while_inside"),
        *_PAUSE,
    ],
    "group_fog": [
        _fog("group_valid && colours_valid;", "group_valid && colours_valid && !finished;", "shown.valid_stays"),
        _fog("out_ready(out_ready && colours_valid)", "out_ready(colours_valid)", "shown.payload_stable"),
        _fog("in_ready = room && ends;", "in_ready = room && ends && !valid[1];", "taken_in_time"),
        _fog("if (sends) second <= !ends;", "second <= !ends;", "in_order"),
        _fog("out_ready(out_ready && colours_valid)", "out_ready(out_ready)", "in_order"),
        _fog("out_ready(out_ready && group_valid)", "out_ready(out_ready || half_12)", "in_order"),
        _fog("finished <= valid[LAST] && ends_12;", "finished <= valid[LAST];", "in_order"),
        _fog("finished <= valid[LAST] && ends_12;", "finished <= valid[LAST] && ends_12 && in_valid;", "shown_in_time"),
        _fog("assign out_valid = group_valid && colours_valid;", "assign out_valid = group_valid || colours_valid;", "nothing_made_up"),
        _fog("assign idle      = !group_valid;", "assign idle      = !out_valid;", "idle_when_empty"),
    ],
    "smooth_shader": [
        _fifo("stored || read_valid && !read_ready;", "stored;", "shown.valid_stays"),
        _fifo("!read_valid || read_ready;", "!read_valid || read_ready || stored;", "shown.payload_stable"),
        _smooth("group_valid && (!group_smooth || colours_valid)", "group_valid", "in_order"),
        _smooth("out_ready && (!group_smooth || colours_valid)", "out_ready", "in_order"),
        _smooth("in_valid && in_smooth)", "in_valid)", "in_order"),
        _smooth("takes && is_last)", "takes)", "in_order"),
        _queue("DEPTH - FLIGHT - 2;", "DEPTH - FLIGHT + 1;", "in_order"),
        _smooth("assign out_valid   = group_valid &&", "assign out_valid   =", "nothing_made_up"),
        _queue("level == '0;", "level <= LEVEL_BITS'(1);", "idle_when_empty"),
        _smooth("finished <= valid[LATENCY] && ends;", "finished <= valid[LATENCY] && ends && !group_valid;", "shown_in_time"),
        _queue("room  <= level <=", "room  <= level ==", "taken_in_time"),
    ],
    "texture_queue": [
        _steps("pointer_t'(STEPS - 2)", "pointer_t'(STEPS)", "never_too_full"),
        _steps("head + pointer_t'(reads)", "head + pointer_t'(reads || fills)", "in_order"),
        _steps("head_places <= places[next[", "head_places <= places[head[", "in_order"),
        _steps("places_end + INDEX_BITS'(places_valid)", "places_end + INDEX_BITS'(step_valid)", "in_order"),
        _steps("reads      <= next_valid && next_missed", "reads      <= next_missed", "nothing_made_up"),
        _steps("fill_second && (left & (left - 4'd1)) == '0", "fill_second", "read_complete"),
        _steps("fills && fill_second && (left", "fills && (left", "read_complete"),
        _steps("left[0] ? 2'd0 : left[1] ? 2'd1 : left[2] ? 2'd2 : 2'd3", "left[1] ? 2'd1 : left[0] ? 2'd0 : left[2] ? 2'd2 : 2'd3",
               "missed_filled"),
        _steps("data_ready && data_valid;", "data_ready;", "word_taken"),
        _steps("count == '0;", "count <= pointer_t'(1);", "idle_when_empty"),
        _steps("reads      <= next_valid && next_missed == '0;", "reads      <= next_valid && next_missed == '0 && !reads;", "goes_in_time"),
        _steps("!data_ready && out_room", "!data_ready", "waits_for_room"),
        _steps("count <= MOST;", "count == MOST;", "taken_in_time"),
    ],
    "cpu_bus": [
        _cpu_bus("busy.eq(asks_data | asks_instructions)", "busy.eq(asks_data)", "shown"),
        _cpu_bus("& ~reads_data)", ")", "unchanged"),
        _cpu_bus("Cat(data.sel,", "Cat(instructions.sel,", "written_as"),
        _cpu_bus("Cat(instructions.sel,", "Cat(data.sel,", "read_whole"),
        _cpu_bus("word != LINE_WORDS - 1", "word != LINE_WORDS - 2", "burst_ends"),
        _cpu_bus("(asks_data & data.we & free)", "(asks_data & data.we & ~busy)", "answered"),
        _cpu_bus("instructions.dat_r.eq(bus.dat_r)", "instructions.dat_r.eq(0)", "data_pass"),
    ],
    "memory_multiplexer": [
        _multiplexer("opens & turns.turn[number] & fits", "opens & fits", "one_at_a_time"),
        _multiplexer("refresher.cmd.a, selected(\"a\")", "selected(\"a\"), selected(\"a\")", "reaches_memory"),
        _multiplexer("phase.wrdata_en.eq(writing)", "phase.wrdata_en.eq(reads)", "data_pass"),
        _multiplexer("_Timer(timing.tRRD)", "_Timer(timing.tRRD - 1)", "activates_apart"),
        _multiplexer("cmd.we | (activations.ready & four_activations.ready)", "cmd.we | activations.ready", "four_activates"),
        _multiplexer("_Timer(timing.tCCD)", "_Timer(timing.tCCD - 1)", "columns_apart"),
        # Fault: a change counts from the last command of the wrong direction.
        _multiplexer("Mux(writes, after_reads.ready, after_writes.ready)", "after_writes.ready", "read_to_write"),
        _multiplexer("Mux(writes, after_reads.ready, after_writes.ready)", "after_reads.ready", "write_to_read"),
        _multiplexer("reduce(and_, (bank.refresh_gnt", "reduce(or_, (bank.refresh_gnt", "refresh_alone"),
        _multiplexer("NextState(\"REFRESH\")", "NextState(\"OPEN\")", "refresh_in_time"),
        _multiplexer("bank.refresh_req.eq(refresher.cmd.valid)", "bank.refresh_req.eq(0)", "asks_all"),
        # Fault: the direction changes only when no command of the other direction is pending.
        _multiplexer("~pending | left[-1]", "~pending", "given_in_time"),
    ],
    "axi_ports": [
        _axi("turns.holds.eq(channel.valid & ~channel.ready)", "turns.holds.eq(0)", "read_addresses.payload_stable"),
        _axi("port.cmd.valid & (level", "~axi.b.valid & port.cmd.valid & (level", "write_addresses.valid_stays"),
        _axi("mine & want & channel.ready", "want & channel.ready", "reads_pass"),
        _axi("mine & want & channel.ready", "want & channel.ready", "writes_pass"),
        _axi("channel.burst.eq(_BURST_INCR), ", "", "single_words"),
        _axi("axi.w.valid.eq(order.source.valid & ", "axi.w.valid.eq(", "word_follows"),
        _axi("order.source.ready & (order.source.port == number)", "order.source.ready", "word_taken"),
        _axi("axi.r.valid & (axi.r.id == number)", "axi.r.valid", "answers_pass"),
        _axi("axi.r.ready.eq(1)", "axi.r.ready.eq(~axi.aw.valid)", "answers_taken"),
        # Fault: a write counts as done when its word is taken.
        _axi("axi.b.valid & (axi.b.id == number)", "port.wdata.ready", "pending_writes"),
        _axi("(level != most_writes) & order.sink.ready", "order.sink.ready", "not_too_many"),
        _axi("axi.b.valid & (axi.b.resp != _RESPONSE_OKAY)", "0", "errors"),
        _axi("turns.holds.eq(channel.valid & ~channel.ready)", "turns.holds.eq(channel.valid)", "taken_in_time"),
    ],
    "wishbone_ports": [
        _wishbone("bus.sel.eq(Mux(bus.we,", "bus.sel.eq(Mux(self.error,", "requests.payload_stable"),
        _wishbone("If(ended, NextState(\"COMMAND\"))", "NextState(\"COMMAND\")", "requests.valid_stays"),
        _wishbone("port.cmd.ready.eq(mine)", "port.cmd.ready.eq(1)", "one_at_a_time"),
        _wishbone("int(port.mode == \"write\")", "int(port.mode == \"read\")", "as_it_came"),
        _wishbone("Mux(bus.we, self._selected(owners,", "Mux(~bus.we, self._selected(owners,", "word_passes"),
        _wishbone("port.wdata.ready.eq(ended & owner[number])", "port.wdata.ready.eq(ended)", "word_taken"),
        _wishbone("port.rdata.valid.eq(ended & owner[number])", "port.rdata.valid.eq(ended)", "read_answered"),
        _wishbone("bus.cyc & bus.err", "bus.err & 0", "errors"),
        _wishbone("turns.wants.eq(Cat(*wants))", "turns.wants.eq(Cat(wants[0]))", "taken_in_time"),
    ],
    "memory_crossbar": [
        _crossbar("(turn[number] & may)", "(may)", "one_at_a_time"),
        _crossbar("selected(allowed)", "allowed[0]", "as_it_came"),
        # Fault: a port requests a second bank before the first bank has completed its commands.
        _crossbar("~level[0] & ~Array(owned", "~Array(owned", "in_order"),
        _crossbar("Mux(stays, ~level[-1],", "Mux(stays, 1,", "room_in_queue"),
        _crossbar("level[0] & (place == done)", "level[0]", "read_answered"),
        _crossbar("ended & done_write, self.write_latency", "ended & done_write, self.write_latency + 1", "data_asked"),
        _crossbar("Mux(ended, len(writers), 0)", "Mux(ended, 0, len(writers))", "data_pass"),
        _crossbar("valid.eq(selected(allowed))", "turns.holds.eq(~valid), valid.eq(selected(allowed))", "idle_takes"),
        # Fault: a port keeps its bank forever.
        _crossbar("owner & ~level[0] & ~(port.cmd.valid & stays)", "0", "taken_in_time"),
    ],
    "classify": [
        _classify("known        <= !in_ready && !leaves;", "known        <= !in_ready && !known;", "exception.valid_stays"),
        _held("if (enables[i]) out", "if (1'b1) out", "in_order"),
        _held("if (enables[i]) out", "if (1'b1) out", "regular.payload_stable"),
        _classify("if (leaves) count", "if (known) count", "counted"),
        _classify("if (leaves) count", "if (known) count", "exception.payload_stable"),
        _classify("known && !to_regular && !to_exception;", "known && !to_regular;", "leaves_one_way"),
        _classify("unseen           = known &&", "unseen           =", "nothing_made_up"),
        _classify("assign idle           = in_ready;", "assign idle           = !known;", "idle_while_empty"),
        _classify("!to_exception || exception_ready", "exception_ready", "taken_in_time"),
    ],
    "setup": [
        _setup("if (out_ready) out_valid <= 1'b0;", "out_valid <= 1'b0;", "shown.valid_stays"),
        _setup("waits      = valid[4] && out_valid && !out_ready;", "waits      = 1'b0;", "shown.payload_stable"),
        _setup("enable <= !ending || beat_comes;", "enable <= 1'b1;", "dut.shade.in_step"),
        _setup("enable <= !ending || beat_comes;", "enable <= !ending;", "dut.shade.in_step"),
        _setup("if (beat && valid[4]) out_valid", "if (beat) out_valid", "nothing_made_up"),
        _setup("origin_3, lit_3, start_3}", "origin_3, lit_2, start_3}", "in_order"),
        _setup("drawn <= beat && valid[4];", "drawn <= beat;", "counted"),
        _setup("cull_busy || valid != '0 || out_valid", "cull_busy || valid[3:1] != '0 || out_valid", "busy_while_inside"),
        _setup("valid <= {valid[3:1], first_valid};", "valid <= {1'b0, valid[2:1], first_valid};", "busy_while_inside"),
        # Fault: triangles wait for later triangles, or for the consumer.
        _setup("end else if (count != LAST) begin", "end else if (count != LAST && first_valid) begin", "no_standstill"),
        _setup("end else if (count != LAST) begin", "end else if (count != LAST && out_ready) begin", "taken_in_time"),
    ],
    "band_entry": [
        _entry(".leaves(out_ready)", ".leaves(1'b1)", "shown.valid_stays"),
        _held("if (enables[i]) out", "if (1'b1) out", "shown.payload_stable"),
        _entry("pass == ROWS_KNOWN && count == '0;", "1'b0;", "nothing_made_up"),
        # Fault: the next triangle overwrites the held one.
        _entry("pass != STALLS || !held_valid || !out_valid;", "1'b1;", "in_order"),
        _entry("if (copies[0]) begin", "if (busy) begin", "in_order"),
        _entry("if (copies[1]) begin", "if (busy) begin", "in_order"),
        _entry("if (moved) out_late", "out_late", "in_order"),
        _entry("k == 2 ? ending[2] :", "k == 2 ? ending[1] :", "in_order"),
        _held("enables[i] ? !in_valid :", "enables[i] ? 1'b1 :", "nothing_too_many"),
        _entry("(ending != '0 || held_valid) && held_odd", "held_valid && held_odd", "held_is_told"),
        _entry("{ending[2:1], busy && pass == LAST}", "{ending[2:1], busy && pass == LAST && in_valid}", "shown_in_time"),
        _entry("end else if (advance) begin", "end else if (advance && out_ready) begin", "taken_in_time"),
    ],
    "walker": [
        _walker("if (out_ready) begin\n            group ", "if (1'b1) begin\n            group ", "shown.valid_stays"),
        _walker("if (out_ready) begin\n            group ", "if (1'b1) begin\n            group ", "shown.payload_stable"),
        _walker("= active && !fails;", "= !fails;", "nothing_made_up"),
        _walker("(!keep || !left) && !at_right;", "(!keep || !left);", "within_bounds"),
        _walker("(!keep || left) && !at_left;", "!at_left;", "none_twice"),
        _walker("(!keep || left) && !at_left;", "!at_left;", "left_in_time"),
        _walker("late_advance && late_move == raster_pkg::LOAD) begin", "late_move == raster_pkg::LOAD) begin", "nothing_made_up"),
        _walker("!in_valid || in_triangle.rows == 6'd1;", "1'b1;", "none_left_out"),
        _walker("            active       <= 1'b0;", "            active       <= 1'b1;", "busy_while_it_walks"),
    ],
    "line_setup": [
        _line_setup("out_valid <= copies || out_valid && !out_ready;", "out_valid <= copies;", "shown.valid_stays"),
        _line_setup("if (copies) begin", "if (walking) begin", "shown.payload_stable"),
        _line_setup("waiting && in_valid};", "waiting};", "of_a_segment"),
        _line_setup("waiting && in_valid};", "waiting};", "taken_if_given"),
        _line_setup("else if (copies) entered <= 1'b0;", "", "one_in_a_band"),
        _line_setup("= entered && shown && !reached;", "= entered && !reached;", "within_picture"),
        _line_setup("at[17]    <= at[16] && remaining > 0;", "at[17]    <= at[16];", "with_a_pixel"),
        _line_setup("(leaves || walks && remaining == 14'sd1)", "leaves", "taken_in_time"),
        _line_setup("= finished && !out_valid;", "= finished;", "then_the_next"),
    ],
    "line_raster": [
        _fifo("DIRECT ? stored", "DIRECT ? stored && !in_valid", "shown.valid_stays"),
        _fifo("!read_valid || read_ready;", "!read_valid || read_ready || stored;", "shown.payload_stable"),
        _line_raster("room && active && shown};", "room && shown};", "nothing_made_up"),
        _line_raster("pixel.colour <= colour;", "pixel.colour <= in_piece.colour;", "in_order"),
        _queue("DEPTH - FLIGHT - 2;", "DEPTH - FLIGHT + 1;", "nothing_too_many"),
        _line_raster("assign idle = !active && valid", "assign idle = valid", "idle_when_empty"),
        _line_raster("valid <= {valid[1],", "if (in_valid) valid <= {valid[1],", "shown_in_time"),
        _queue("room  <= level <=", "room  <= level ==", "taken_in_time"),
    ],
    "cdc_fifo": [
        _crossing("head_gray <= head_next ^ head_next >> 1;", "head_gray <= head_next;", "nothing_made_up"),
        _crossing("if (in_valid && in_ready) places", "if (in_valid) places", "in_order"),
        _crossing("holding  <= tail_gray != head_seen;", "holding  <= load;", "nothing_made_up"),
        _crossing("pointer_t'(3) << (PLACE_BITS - 1);", "pointer_t'(1) << PLACE_BITS;", "nothing_too_many"),
        _crossing("!holding || out_ready;", "1'b1;", "valid_stays"),
        _crossing("!holding || out_ready;", "!holding || out_ready || tail_gray != head_seen;", "payload_stable"),
        _crossing("        head_gray <=", "        if (!in_valid) head_gray <=", "shown_in_time"),
        _crossing("head_gray != (tail_seen ^ FULL);", "head_gray == (tail_seen ^ FULL);", "taken_in_time"),
    ],
    "camera_capture": [
        _capture("lost <= !token_ready;", "lost <= lost && !token_ready;", "reported"),
        _capture("        if (token_valid) lost", "        lost", "reported"),
        _capture("if (was_in_line && !in_line)", "if (was_in_line && !in_line && !between)", "line_ends"),
        _capture("TOKEN_PIXEL;", "TOKEN_PIXEL | {2{half}};", "known_kind"),
        _capture("{14'd0, between, half}", "{15'd0, between}", "has_bytes"),
    ],
    "lanes": [
        _fifo("DIRECT ? stored", "DIRECT ? stored && !in_valid", "shown.valid_stays"),
        _fifo("!read_valid || read_ready;", "!read_valid || read_ready || stored;", "shown.payload_stable"),
        _lanes("valid[4] && mask != '0;", "valid[4];", "nothing_made_up"),
        _lanes("{line_4, column_4, colour_4}", "{line_4, column_3, colour_4}", "in_order"),
        _queue("DEPTH - FLIGHT - 2;", "DEPTH - FLIGHT;", "nothing_too_many"),
        _lanes("valid == '0 &&", "valid[3:1] == '0 &&", "idle_when_empty"),
        _queue("assign idle = level == '0;", "assign idle = 1'b1;", "idle_when_empty"),
        _lanes("valid     <= {valid", "if (in_valid) valid <= {valid", "shown_in_time"),
        _queue("room  <= level <=", "room  <= level ==", "taken_in_time"),
    ],
}
