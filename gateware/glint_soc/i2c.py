"""Register block of the I2C master (rtl/i2c)."""

from litex.gen import LiteXModule
from litex.soc.interconnect.csr import CSRField, CSRStatus, CSRStorage
from litex.soc.interconnect.csr_eventmanager import EventManager, EventSourcePulse
from migen import ClockSignal, Instance, ResetSignal, Signal
from migen.fhdl.specials import Tristate

from .clock_control import ClockControl
from .packed import Enumeration, Package, Struct
from .rtl import add_sources

BIT_RATE = 400_000
"""Largest bit rate of the bus in bit/s: I2C fast mode."""

OPERATIONS = Enumeration("operation", "Operations of a command.", {
    "start": "start condition, or repeated start within a transaction",
    "write": "send the byte `argument`",
    "read": "receive `argument` + 1 bytes",
    "stop": "stop condition",
})

ERRORS = Enumeration("error", "Errors.", {
    "none": "no error",
    "address": "the address byte was not acknowledged",
    "byte": "another byte was not acknowledged",
    "clock": "a device held SCL low beyond the stretching limit",
    "data": "a device held SDA low, and nine clocks did not release it",
    "late": "a round was still running when the next one was due",
})

COMMANDS = 32
ANSWERS = 128
"""Depth of the command FIFO and of the FIFO of received bytes, without their output registers."""


class I2CMaster(LiteXModule):
    """Executes a queue of commands on `pads` and queues the received bytes."""

    def __init__(self, platform, pads, sys_clk_freq):
        self._command = CSRStorage(name="command", fields=[
            CSRField("argument", size=8, offset=0, description="Byte to send (`write`), or number of bytes to receive minus 1 (`read`)."),
            CSRField("operation", size=OPERATIONS.bits, offset=8, values=OPERATIONS.values, description="Operation."),
            CSRField("more", offset=10, description="A `read` also acknowledges its last byte, because another `read` follows."),
        ], description=f"A write appends a command to the queue of {COMMANDS + 1} commands. A full queue drops the command, see `room`.")
        self._answer = CSRStatus(name="answer", fields=[
            CSRField("byte", size=8, offset=0, description="Received byte."),
            CSRField("valid", offset=8, description="`byte` is valid."),
        ], description=f"A read removes the next byte from the queue of {ANSWERS + 1} bytes. The master waits while the queue is full.")
        self._control = CSRStorage(name="control", fields=[
            CSRField("clear", offset=0, pulse=True, description="Write 1 to release the wires, empty both queues and clear the error."),
        ], description="Operation.")
        self._rounds = CSRStorage(name="rounds", fields=[
            CSRField("period", size=24, offset=0, description="Clock cycles between the starts of two rounds, minus 1."),
            CSRField("batch", size=4, offset=24, description="Rounds per interrupt, minus 1."),
            CSRField("repeats", offset=31, description="Repeat the commands in the queue. The first round begins one period after "
                     "this write."),
        ], description="A round is one execution of a transaction that is repeated periodically. Its commands are queued before the first "
                       "round.")
        self._status = CSRStatus(name="status", fields=[
            CSRField("scl", offset=0, description="State of the SCL wire."),
            CSRField("sda", offset=1, description="State of the SDA wire."),
            CSRField("room", offset=2, description="The command queue is not full."),
            CSRField("busy", offset=3, description="A transaction runs, or commands are queued."),
            CSRField("failed", offset=4, description="An error has ended the transaction; commands wait for `clear`."),
            CSRField("error", size=ERRORS.bits, offset=8, values=ERRORS.values, description="Error."),
        ], description="State.")
        # A queue holds one entry more than its FIFO, because of the output register.
        self.constants = {
            "command_places": (COMMANDS + 1, "Capacity of the queue of commands."),
            "answer_places": (ANSWERS + 1, "Capacity of the queue of received bytes."),
        }
        self.ev = EventManager()
        self.ev.ended = EventSourcePulse(name="ended", description="A transaction or the last round of a batch has ended, or an error has "
                                         "occurred.")
        self.ev.finalize()

        command = Struct("command_t", "A command.", {
            name: getattr(self._command.fields, name) for name in ("more", "operation", "argument")})
        self.package = Package("i2c", enumerations=[OPERATIONS, ERRORS], structs=[command])

        reset = Signal()
        wires = {name: Signal() for name in ("scl_in", "scl_out", "sda_in", "sda_out")}
        self.comb += reset.eq(ResetSignal("sys") | self._control.fields.clear)
        self.specials += Instance("i2c_engine", name="i2c_core",
            # A bit has three phases. The number of clocks per phase is rounded up, so that the bit rate is at most BIT_RATE.
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
        self.clock_control = ClockControl(
            self._status.fields.busy | self._rounds.fields.repeats | ~wires["scl_in"] | ~wires["sda_in"])
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
