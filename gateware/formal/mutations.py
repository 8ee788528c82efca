"""How each property is shown to be able to fail: a textual change of a module, and the property that has to notice it."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Mutation:
    """In `source`, `old` (which is there once) becomes `new`; then `fails`, a path within the proof, does not hold."""

    source: str
    old: str
    new: str
    fails: str


def _skid(old, new, fails):
    return Mutation("skid_buffer.sv", old, new, fails)


def _fifo(old, new, fails):
    return Mutation("fifo.sv", old, new, fails)


def _flush(old, new, fails):
    return Mutation("band_flush.sv", old, new, fails)


def _pipe(old, new, fails):
    return Mutation("band_pipe.sv", old, new, fails)


def _cull(old, new, fails):
    return Mutation("cull.sv", old, new, fails)


_FIFO = [
    _fifo("out_valid <= stored;", "out_valid <= stored && in_valid;", "order.shown_in_time"),
    _fifo("load     = !out_valid || out_ready", "load     = !out_valid || out_ready || stored", "shown.payload_stable"),
    _fifo("load     = !out_valid || out_ready", "load     = 1'b1", "shown.valid_stays"),
    _fifo("out_valid <= stored;", "out_valid <= stored || in_valid;", "order.nothing_made_up"),
    _fifo("head != {~tail[PLACE_BITS], tail[PLACE_BITS-1:0]}", "1'b1", "order.nothing_too_many"),
    _fifo("if (stored) tail", "if (stored && !in_valid) tail", "order.in_order"),
    _fifo("if (in_valid && in_ready)", "if (in_valid)", "order.in_order"),
    _fifo("head != {~tail[PLACE_BITS], tail[PLACE_BITS-1:0]}", "head == '0", "order.taken_in_time"),
]

MUTATIONS = {
    "skid_buffer": [
        _skid("in_valid || !in_ready;", "in_valid && in_ready;", "order.shown_in_time"),
        _skid("in_valid || !in_ready;", "1'b1;", "order.nothing_made_up"),
        _skid("if (in_ready) spare", "spare", "order.in_order"),
        _skid("in_ready ? in_data : spare", "in_data", "order.in_order"),
        _skid("in_ready <= 1'b0;", "in_ready <= 1'b1;", "order.nothing_too_many"),
        _skid("if (!out_valid || out_ready)", "if (1'b1)", "shown.valid_stays"),
        _skid("if (!out_valid || out_ready)", "if (!out_valid || out_ready || in_valid)", "shown.payload_stable"),
        _skid(": spare;\n            in_ready  <= 1'b1;", ": spare;", "order.taken_in_time"),
    ],
    "fifo of 2": _FIFO,
    "fifo of 4": _FIFO,
    "band_flush": [
        _flush("to_command != '0;", "to_command != '0 && !word_valid;", "commands.valid_stays"),
        _flush("if (commanded) begin", "if (cmd_valid) begin", "commands.payload_stable"),
        _flush("word_stored && owed != '0;", "word_stored && owed != '0 && !word_valid;", "words.valid_stays"),
        _flush(".out_ready(wdata_ready && owed != '0)", ".out_ready(owed != '0)", "words.payload_stable"),
        _flush("depth_address  <= depth_base;", "depth_address  <= base;", "commands_in_order"),
        _flush("            cmd_part       <= COLOUR;\n", "", "commands_in_order"),
        # More words than there are places.
        _flush("state == FLUSH && places != '0;", "state == FLUSH;", "words_in_order"),
        # A row that is cleared before its depth has been read.
        _flush("clears <= row_ends;", "clears <= 1'b1;", "words_in_order"),
        _flush("{18{written[lane]}}", "18'b0", "words_in_order"),
        _flush("if (row == last_row)", "if (row == '1)", "none_made_up"),
        # A command before its data.
        _flush("word_valid && word_ready;", "asked_2 && word_ready;", "data_at_command"),
        _flush("if (taken && !issue)", "if (commanded && !issue)", "commands_match"),
        _flush("last_row   <= rows - 1'b1;", "last_row   <= rows - 2'd2;", "none_left_out"),
        _flush("places <= places + 1'b1;", "places <= places;", "no_standstill"),
        _flush("owed <= owed - 1'b1;", "owed <= owed;", "data_at_command"),
        _flush("if (row == '1) state", "if (row == '1 && idle) state", "sweep_ends"),
        # A restart that waits for memory.
        _flush("SWEEP: begin", "SWEEP: if (places == COUNT_BITS'(WORDS)) begin", "sweep_ends"),
        # A restart that begins where the flush was.
        _flush("state  <= SWEEP;\n            row    <= '0;", "state  <= SWEEP;", "all_swept"),
        _flush("clears <= row_ends;", "clears <= row_ends && row != last_row;", "cleared_behind"),
        _flush("clear_row <= row;", "clear_row <= row + 1'b1;", "cleared_behind"),
    ],
    "band_pipe": [
        _pipe("hold <= 2'd3;", "hold <= 2'd2;", "drawn_as_given"),
        _pipe("hold <= 2'd2;", "hold <= 2'd1;", "drawn_as_given"),
        _pipe("            else if (conflict_1) hold <= 2'd1;\n", "", "drawn_as_given"),
        _pipe("comparing.codes[18*lane +: 18] >=", "comparing.codes[18*lane +: 18] >", "drawn_as_given"),
        _pipe("!stored_written[lane] ||", "", "drawn_as_given"),
        _pipe("hold <= hold - 1'b1;", "hold <= hold;", "taken_in_time"),
    ],
    "cull": [
        _cull("if (advance) phase", "if (advance && !drop) phase", "taken_in_time"),
        _cull("if (advance) phase", "if (advance && !drop) phase", "leaves_in_time"),
        _cull("last_valid && !drop;", "last_valid && !drop && !first_valid;", "nothing_too_many"),
        _cull("in_ready && last_valid && drop;", "in_ready && drop;", "nothing_made_up"),
        _cull("first_valid || last_valid || out_valid;", "first_valid || last_valid;", "busy_while_inside"),
        _cull("if (!out_valid || out_ready) begin", "if (1'b1) begin", "shown.valid_stays"),
        _cull("if (!out_valid || out_ready) begin", "if (1'b1) begin", "shown.payload_stable"),
    ],
}
