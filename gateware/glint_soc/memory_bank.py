"""Bank machine of the memory controller: converts requests to memory commands and keeps the timing between them."""

import math

from litedram.common import cmd_layout, cmd_request_rw_layout, tXXDController
from litex.gen import LiteXModule
from litex.soc.interconnect import stream
from migen import FSM, Cat, If, Mux, NextState, Record, Replicate, Signal


class MemoryBank(LiteXModule):
    """Replaces LiteDRAM's bank machine `number`: accepts requests, and issues the commands that they need.

    LiteDRAM's machine compares the row of a request in the clock of its command: with the open row, and, for the automatic precharge,
    with the row of the next request. Here a request is compared with the previous request when it arrives, and the result is stored
    with it: `turns` is high if the request is for another row.

        requests ─▶ another row than before? ─┬─────────────────────┬─▶ request ─▶ commands
                                              └─▶ queue ────────────┘
                                                    └─▶ next turns: precharge

    Latency: a request waits in the queue only if an earlier request is pending. Without an earlier request and with its row open, the
    command of a request follows one clock after the request, one clock earlier than in LiteDRAM.
    """

    def __init__(self, number, address_bits, alignment, settings):
        self.req = req = Record(cmd_layout(address_bits))
        self.refresh_req, self.refresh_gnt = Signal(), Signal()
        geometry, timing = settings.geom, settings.timing
        if geometry.colbits > 10:
            raise ValueError(f"{geometry.colbits} bits of column: expected at most 10")
        self.cmd = cmd = stream.Endpoint(cmd_request_rw_layout(geometry.addressbits, geometry.bankbits))

        layout = [("we", 1), ("addr", address_bits), ("turns", 1)]
        self.queue = queue = stream.SyncFIFO(layout, settings.cmd_buffer_depth)
        self.request = request = stream.Buffer(layout)
        columns = geometry.colbits - alignment
        newest, turns, waits = Signal(address_bits - columns), Signal(), Signal()
        arriving = Cat(req.we, req.addr, turns)
        self.comb += [
            turns.eq(req.addr[columns:] != newest),
            waits.eq(queue.source.valid | request.source.valid),
            queue.sink.valid.eq(req.valid & waits),
            queue.sink.payload.raw_bits().eq(arriving),
            queue.source.ready.eq(request.sink.ready),
            request.sink.valid.eq(queue.source.valid | (req.valid & ~waits)),
            request.sink.payload.raw_bits().eq(Mux(queue.source.valid, queue.source.payload.raw_bits(), arriving)),
            request.source.ready.eq(req.wdata_ready | req.rdata_valid),
            req.ready.eq(queue.sink.ready),
            req.lock.eq(waits),
        ]
        self.sync += If(req.valid, newest.eq(req.addr[columns:]))

        # `row_hit` is high if the open row is the row of the request.
        row_opened, row_hit, row_open, row_close, ends_row = (Signal() for _ in range(5))
        gets_request, shows_row = Signal(), Signal()
        address = request.source.addr
        self.comb += [
            gets_request.eq(request.sink.valid & request.sink.ready),
            ends_row.eq(queue.source.valid & queue.source.turns),
            cmd.ba.eq(number),
            If(shows_row,
                cmd.a.eq(address[columns:]),
            ).Else(
                # Bit 10 requests the automatic precharge.
                cmd.a.eq(Cat(Replicate(0, alignment), address[:columns], Replicate(0, 10 - geometry.colbits), ends_row)),
            ),
        ]
        self.sync += [
            If(gets_request, row_hit.eq(~request.sink.turns)).Elif(row_open, row_hit.eq(1)),
            If(row_close, row_opened.eq(0)).Elif(row_open, row_opened.eq(1)),
        ]

        given = Signal()
        write_latency = math.ceil(settings.phy.cwl / settings.phy.nphases)
        self.after_write = after_write = tXXDController(write_latency + timing.tWR + timing.tCCD)
        self.between_activates = between_activates = tXXDController(timing.tRC)
        self.after_activate = after_activate = tXXDController(timing.tRAS)
        may_close = Signal()
        self.comb += [
            given.eq(cmd.valid & cmd.ready),
            after_write.valid.eq(given & cmd.is_write),
            between_activates.valid.eq(given & row_open),
            after_activate.valid.eq(given & row_open),
            may_close.eq(after_write.ready & after_activate.ready),
        ]

        self.fsm = fsm = FSM()
        fsm.act("REGULAR",
            If(self.refresh_req,
                NextState("REFRESH"),
            ).Elif(request.source.valid,
                If(row_opened & row_hit,
                    cmd.valid.eq(1),
                    cmd.cas.eq(1),
                    cmd.we.eq(request.source.we),
                    cmd.is_write.eq(request.source.we),
                    cmd.is_read.eq(~request.source.we),
                    req.wdata_ready.eq(cmd.ready & request.source.we),
                    req.rdata_valid.eq(cmd.ready & ~request.source.we),
                    If(cmd.ready & ends_row,
                        NextState("AUTOPRECHARGE"),
                    ),
                ).Elif(row_opened,
                    NextState("PRECHARGE"),
                ).Else(
                    NextState("ACTIVATE"),
                )
            )
        )
        fsm.act("PRECHARGE",
            row_close.eq(1),
            If(may_close,
                cmd.valid.eq(1),
                cmd.ras.eq(1),
                cmd.we.eq(1),
                cmd.is_cmd.eq(1),
                If(cmd.ready,
                    NextState("TRP"),
                ),
            )
        )
        fsm.act("AUTOPRECHARGE",
            row_close.eq(1),
            If(may_close,
                NextState("TRP"),
            )
        )
        fsm.act("ACTIVATE",
            If(between_activates.ready,
                shows_row.eq(1),
                row_open.eq(1),
                cmd.valid.eq(1),
                cmd.ras.eq(1),
                cmd.is_cmd.eq(1),
                If(cmd.ready,
                    NextState("TRCD"),
                ),
            )
        )
        fsm.act("REFRESH",
            row_close.eq(1),
            cmd.is_cmd.eq(1),
            self.refresh_gnt.eq(after_write.ready),
            If(~self.refresh_req,
                NextState("REGULAR"),
            )
        )
        fsm.delayed_enter("TRP", "ACTIVATE", timing.tRP - 1)
        fsm.delayed_enter("TRCD", "REGULAR", timing.tRCD - 1)
