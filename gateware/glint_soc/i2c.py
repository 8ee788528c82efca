"""The I2C master. The work is done by rtl/i2c; this is its register block."""

from litex.gen import LiteXModule
from litex.soc.interconnect.csr import CSRField, CSRStatus, CSRStorage
from litex.soc.interconnect.csr_eventmanager import EventManager, EventSourcePulse
from migen import ClockSignal, Instance, ResetSignal, Signal
from migen.fhdl.specials import Tristate

from .packed import Enumeration, Package, Struct
from .rtl import add_sources

BIT_RATE = 400_000
"""Fast mode, in bits a second at most."""

OPERATIONS = Enumeration("operation", "Operations of a command.", {
    "start": "a start, or within a transaction a repeated one",
    "write": "sends the byte `argument`",
    "read": "receives `argument` + 1 bytes",
    "stop": "a stop",
})

ERRORS = Enumeration("error", "Errors.", {
    "none": "no error",
    "address": "the byte after a start was not acknowledged",
    "byte": "another byte was not acknowledged",
    "clock": "SCL was held low longer than a device may stretch it",
    "data": "SDA was low where it should have been free, and nine clocks did not free it",
    "late": "a round was not over when the next one was due",
})

COMMANDS = 32
ANSWERS = 128
"""Places in the queues, but for the one that is about to leave."""


class I2CMaster(LiteXModule):
    """Works off a queue of starts, bytes and stops on `pads`, and keeps the bytes that it has received."""

    def __init__(self, platform, pads, sys_clk_freq):
        self._command = CSRStorage(name="command", fields=[
            CSRField("argument", size=8, offset=0, description="Of `write` and `read`."),
            CSRField("operation", size=OPERATIONS.bits, offset=8, values=OPERATIONS.values, description="What to do."),
            CSRField("more", offset=10, description="A `read` acknowledges its last byte too: another one follows."),
        ], description=f"A write puts a command into the queue of {COMMANDS + 1}; one that has no room, see `status`, is lost.")
        self._answer = CSRStatus(name="answer", fields=[
            CSRField("byte", size=8, offset=0, description="The byte."),
            CSRField("valid", offset=8, description="There is one."),
        ], description=f"A read takes the next received byte out of the queue of {ANSWERS + 1}; the master waits while that is full.")
        self._control = CSRStorage(name="control", fields=[
            CSRField("clear", offset=0, pulse=True, description="Write 1 to let go of the wires, empty both queues and forget the error."),
        ], description="Operation.")
        self._rounds = CSRStorage(name="rounds", fields=[
            CSRField("period", size=24, offset=0, description="Clock cycles from the start of a round to that of the next, less one."),
            CSRField("batch", size=4, offset=24, description="So many rounds, less one, are an interrupt."),
            CSRField("repeats", offset=31, description="What is in the queue is done again and again, first a period after this is written."),
        ], description="Rounds: one transaction, its commands in the queue before the first of them, at a steady pace.")
        self._status = CSRStatus(name="status", fields=[
            CSRField("scl", offset=0, description="State of the SCL wire."),
            CSRField("sda", offset=1, description="State of the SDA wire."),
            CSRField("room", offset=2, description="There is room for a command."),
            CSRField("busy", offset=3, description="Between a start and the end of the stop, or commands wait."),
            CSRField("failed", offset=4, description="An error has ended the transaction; nothing more is done until `clear`."),
            CSRField("error", size=ERRORS.bits, offset=8, values=ERRORS.values, description="The error."),
        ], description="State.")
        # The engine's queues have a register behind them.
        self.constants = {
            "command_places": (COMMANDS + 1, "Places in the queue of commands."),
            "answer_places": (ANSWERS + 1, "Places in the queue of received bytes."),
        }
        self.ev = EventManager()
        self.ev.ended = EventSourcePulse(name="ended", description="A stop has been made, with rounds the last one of a batch, or an error has ended the transaction.")
        self.ev.finalize()

        # # #

        command = Struct("command_t", "A command.", {
            name: getattr(self._command.fields, name) for name in ("more", "operation", "argument")})
        self.package = Package("i2c", enumerations=[OPERATIONS, ERRORS], structs=[command])

        reset = Signal()
        wires = {name: Signal() for name in ("scl_in", "scl_out", "sda_in", "sda_out")}
        self.comb += reset.eq(ResetSignal("sys") | self._control.fields.clear)
        self.specials += Instance("i2c_engine", name="i2c_core",
            # Three phases are a bit: rounded up, so that it is not too fast.
            p_PHASE         = -int(-sys_clk_freq // (3 * BIT_RATE)),
            p_COMMANDS      = COMMANDS,
            p_ANSWERS       = ANSWERS,
            i_clk           = ClockSignal("sys"),
            i_rst           = reset,
            i_command_valid = self._command.re,
            o_command_ready = self._status.fields.room,
            i_command_data  = command.value,
            i_repeats       = self._rounds.fields.repeats,
            i_period        = self._rounds.fields.period,
            i_batch         = self._rounds.fields.batch,
            o_answer_valid  = self._answer.fields.valid,
            i_answer_ready  = self._answer.we,
            o_answer_data   = self._answer.fields.byte,
            o_busy          = self._status.fields.busy,
            o_failed        = self._status.fields.failed,
            o_error         = self._status.fields.error,
            o_ended         = self.ev.ended.trigger,
            o_scl           = self._status.fields.scl,
            o_sda           = self._status.fields.sda,
            i_scl_in        = wires["scl_in"],
            o_scl_out       = wires["scl_out"],
            i_sda_in        = wires["sda_in"],
            o_sda_out       = wires["sda_out"],
        )
        add_sources(platform, "i2c_engine")
        if hasattr(pads, "scl_in"):
            self.comb += [
                pads.scl_out.eq(wires["scl_out"]),
                pads.sda_out.eq(wires["sda_out"]),
                wires["scl_in"].eq(pads.scl_in),
                wires["sda_in"].eq(pads.sda_in),
            ]
        else:
            self.specials += [
                Tristate(pads.scl, o=0, oe=~wires["scl_out"], i=wires["scl_in"]),
                Tristate(pads.sda, o=0, oe=~wires["sda_out"], i=wires["sda_in"]),
            ]
