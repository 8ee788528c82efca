"""The triangle engine: from a mesh in DDR3 to a frame in DDR3. The work is done by rtl/triangle; this is its register block."""

from litex.gen import LiteXModule
from litex.soc.interconnect.csr import CSRField, CSRStatus, CSRStorage
from litex.soc.interconnect.csr_eventmanager import EventManager, EventSourcePulse
from migen import Cat, ClockSignal, If, Instance, Record, ResetSignal, Signal

from .rtl import add_sources

IDENT = int.from_bytes(b"TRIA", "big")

# A group of one pixel, or of one eye's half of it.
_FIELD_GROUP = [("halves", 2), ("row", 11), ("line", 6), ("column", 8), ("mask", 8), ("code", 18), ("colour", 16)]

_ADDRESS_BITS = 23
_COUNT_BITS = 20

_ERRORS = [
    ("0", "none", "no error"),
    ("1", "size", "`size` was 3"),
    ("2", "address", "a region was not at a multiple of 16 bytes, or not wholly in main memory; nothing was touched"),
    ("3", "busy", "started while it was busy; the pass under way went on"),
    ("4", "mesh", "a chunk without vertices, or one beyond `mesh_bytes`; what came before it was drawn"),
    ("5", "full", "no room for all descriptors, list entries or exceptions; what had room was drawn"),
    ("6", "list", "a list was longer than it may be, or named a descriptor beyond the count, or what was no descriptor; the frame is wrong"),
    ("7", "cancelled", "ended by `cancel`"),
]

_SIZES = [("0", "w320", "320x180"), ("1", "w640", "640x360"), ("2", "w1280", "1280x720")]


class TriangleEngine(LiteXModule):
    """Draws meshes, in two passes that may run at the same time for two frames.

    `readers` are three native 128-bit LiteDRAM read ports (triangles, vertices, raster), `writers` four write ports
    (descriptors, lists, frame in even and in odd banks), all in the domain `sys`. `clk`, to be driven, is its clock, or that
    gated by `clock_enable`. `main_ram` is the region they reach. `smooth` builds smooth shading, `fields` the way in for a
    raymarcher: `field`.
    """

    def __init__(self, platform, readers, writers, main_ram, smooth=False, fields=False):
        for port in (*readers, *writers):
            if port.data_width != 128 or port.address_width != _ADDRESS_BITS:
                raise ValueError(f"the triangle engine needs memory ports of 128 bits and {_ADDRESS_BITS} address bits, "
                                 f"got {port.data_width} and {port.address_width}")
        if main_ram.size != 16 << _ADDRESS_BITS or main_ram.origin % main_ram.size:
            raise ValueError(f"the triangle engine needs {16 << _ADDRESS_BITS} bytes of main memory, got {main_ram}")

        self._ident = CSRStatus(32, name="ident", reset=IDENT, description="`TRIA` in ASCII; 0 where the block is absent.")
        self._caps = CSRStatus(name="caps", fields=[
            CSRField("sizes", size=3, offset=0, reset=0b111, description="Bit k is set if `size` k is supported."),
            CSRField("gouraud", offset=3, reset=int(smooth), description="Smooth shading: colours can be interpolated between "
                     "vertices. A descriptor has 96 bytes then, and 48 where it is not built."),
            CSRField("count_bits", size=6, offset=8, reset=_COUNT_BITS, description="Bits of a count of descriptors or entries."),
        ], description="What this block can do.")
        self._control = CSRStorage(name="control", fields=[
            CSRField("cancel", offset=0, pulse=True, description="Write 1 to give up both passes. What is started after it waits "
                     "until memory has answered what was asked and the band buffer is clear."),
        ], description="Operation.")
        self._status = CSRStatus(name="status", fields=[
            CSRField("geometry_busy", offset=0, description="The geometry pass runs."),
            CSRField("raster_busy", offset=1, description="The raster pass runs."),
            CSRField("geometry_error", size=3, offset=4, values=_ERRORS,
                     description="How the geometry pass that was started last has ended."),
            CSRField("raster_error", size=3, offset=8, values=_ERRORS,
                     description="How the raster pass that was started last has ended."),
        ], description="State.")
        self.ev = EventManager()
        self.ev.geometry = EventSourcePulse(name="geometry", description="The geometry pass has ended, see `status`; what it "
            "made is in memory.")
        self.ev.raster = EventSourcePulse(name="raster", description="The raster pass has ended, see `status`; the frame is in "
            "memory.")
        self.ev.finalize()

        # Geometry: parameters that hold while it runs.
        self._geometry = CSRStorage(name="geometry", fields=[
            CSRField("start", offset=0, pulse=True, description="Write 1 to make descriptors and lists of the mesh."),
            CSRField("cull", offset=1, description="Back faces are left out."),
            CSRField("size", size=2, offset=2, values=_SIZES, description="Size of the picture."),
            CSRField("smooth", offset=4, description="Colours come from the vertices. Without effect where `caps` has no `gouraud`."),
        ], description="Starts the geometry pass. All other registers of geometry have to hold while it runs.")
        address = "Byte address, a multiple of 16, of"
        self._mesh = CSRStorage(32, name="mesh", description=f"{address} the mesh's first chunk.")
        self._mesh_bytes = CSRStorage(32, name="mesh_bytes", description="Length of all its chunks, a multiple of 16.")
        self._geometry_descriptors = CSRStorage(32, name="geometry_descriptors", description=f"{address} the descriptors to make.")
        self._descriptor_limit = CSRStorage(_COUNT_BITS, name="descriptor_limit", description="Room there, 48 or 96 bytes each, see `caps`.")
        self._geometry_lists = CSRStorage(32, name="geometry_lists", description=f"{address} the band lists to make.")
        self._list_shift = CSRStorage(5, name="list_shift", description="A band's list has room for 4 << list_shift entries. "
            "Of both passes.")
        self._exceptions = CSRStorage(32, name="exceptions", description=f"{address} the list of exceptions to make.")
        self._exception_limit = CSRStorage(_COUNT_BITS, name="exception_limit", description="Room there, 4 bytes each.")
        self._scale_shift = CSRStorage(5, name="scale_shift", description="Scale shift f of rows U and V.")
        rows = {}
        for row, meaning in [("u", "U"), ("v", "V"), ("n", "n")]:
            for i, axis in enumerate("xyz"):
                register = CSRStorage(25, name=f"row_{row}{i}", description=f"Row {meaning}, {axis}, two's complement.")
                setattr(self, f"_row_{row}{i}", register)
                rows.setdefault(row, []).append(register.storage)
        translation = {}
        for axis, what in [("x", "14 + f"), ("y", "14 + f"), ("z", "37")]:
            low = CSRStorage(32, name=f"t{axis}_low", description=f"Translation t{axis}, {what} fraction bits: bits 0 to 31.")
            high = CSRStorage(12, name=f"t{axis}_high", description=f"Translation t{axis}: bits 32 to 43.")
            setattr(self, f"_t{axis}_low", low)
            setattr(self, f"_t{axis}_high", high)
            translation[axis] = Cat(low.storage, high.storage)
        self._near_low = CSRStorage(32, name="near_low", description="Near plane, 37 fraction bits: bits 0 to 31.")
        self._near_high = CSRStorage(7, name="near_high", description="Near plane: bits 32 to 38.")
        self._depth_scale = CSRStorage(name="depth_scale", fields=[
            CSRField("mantissa", size=17, offset=0, description="km, in 2^16 to 2^17 - 1."),
            CSRField("exponent", size=4, offset=17, description="ke, two's complement."),
        ], description="Depth scale K = km * 2^ke.")

        # Raster: parameters that hold while it runs.
        self._raster = CSRStorage(name="raster", fields=[
            CSRField("start", offset=0, pulse=True, description="Write 1 to draw a frame from lists."),
            CSRField("size", size=2, offset=1, values=_SIZES, description="Size of the picture."),
            CSRField("first", offset=3, description="There is a first set of lists."),
            CSRField("second", offset=4, description="There is a second set, drawn after the first in each band."),
            CSRField("depth", offset=5, description="Depths go to memory as well; the whole frame is written then."),
            CSRField("slot", offset=6, description="Which of two frame buffers `frame` is: what was drawn there is remembered."),
            CSRField("whole", offset=7, description="Nothing is known of what the frame buffer holds: all of it is written. To be "
                     "set for a buffer's first frame, after a cancelled one, after another size or `clear`, and after anybody else "
                     "has written there."),
        ], description="Starts the raster pass. All other registers of the raster have to hold while it runs.")
        self._frame = CSRStorage(32, name="frame", description=f"{address} the frame to write, RGB565.")
        self._depth = CSRStorage(32, name="depth", description=f"{address} the depths to write, 32 bits each.")
        self._clear = CSRStorage(16, name="clear", description="Colour where nothing is drawn, RGB565.")
        for k, which in enumerate(["first", "second"]):
            for name, register in [
                (f"lists_{k}", CSRStorage(32, name=f"lists_{k}", description=f"{address} the {which} set's lists.")),
                (f"descriptors_{k}", CSRStorage(32, name=f"descriptors_{k}", description=f"{address} the {which} set's descriptors.")),
                (f"count_{k}", CSRStorage(_COUNT_BITS, name=f"count_{k}", description=f"Descriptors of the {which} set.")),
            ]:
                setattr(self, f"_{name}", register)

        # Results of the geometry pass that ended last.
        results = {
            "triangles": "Triangles of the mesh.",
            "unseen": "Triangles that were behind, or off one side of the picture.",
            "culled": "Triangles left out by the setup: back faces, those without area or without a pixel's centre in their bounds.",
            "descriptor_count": "Descriptors made.",
            "exception_count": "Triangles that need clipping, listed in `exceptions`.",
        }
        # Counters that run freely.
        counters = {
            "cycles_busy": "Clock cycles in which a pass ran.",
            "cycles_stalled": "Clock cycles in which memory did not take a command.",
            "stalled_reads": "Clock cycles in which memory did not take a read.",
            "stalled_lists": "Clock cycles in which memory did not take a write of the geometry pass.",
            "stalled_frame": "Clock cycles in which memory did not take a write of the raster pass.",
            "items_in": "Words of 16 bytes read from memory.",
            "items_out": "Words of 16 bytes written to memory.",
            "cycles_geometry": "Clock cycles of geometry passes.",
            "vertices": "Vertices transformed.",
            "cycles_raster": "Clock cycles of raster passes.",
            "cycles_walking": "Clock cycles in which a triangle was walked over.",
            "cycles_empty": "Those of them without a pixel.",
            "groups": "Groups of eight pixels of which some are covered.",
            "pixels_covered": "Pixels covered by a triangle, each as often as it is.",
            "pixels_drawn": "Pixels of which the depth was nearer, or as near.",
            "cycles_held": "Clock cycles in which a group waited for the one before it.",
            "cycles_memory": "Clock cycles in which the flush of a band waited for memory.",
            "cycles_flush": "Clock cycles in which a drawn band waited for the flush of the one before it.",
        }
        status = {}
        for name, description in results.items():
            status[name] = CSRStatus(32, name=name, description=description)
        for name, description in counters.items():
            status[name] = CSRStatus(32, name=name, description=description[:-1] + ", modulo 2^32.")
        for name, register in status.items():
            setattr(self, f"_{name}", register)
        self.counters = list(counters)

        # # #

        mesh_reader, vertex_reader, raster_reader = readers
        descriptor_writer, list_writer, even_writer, odd_writer = writers
        # The engine stands still but for these times, so its clock may.
        self.clk = Signal()
        self.clock_enable = Signal()
        recovering, linger = Signal(), Signal(5)
        working = Signal()
        self.comb += [
            working.eq(ResetSignal("sys") | recovering | self._control.fields.cancel
                       | self._status.fields.geometry_busy | self._status.fields.raster_busy),
            self.clock_enable.eq(working | (linger != 0)),
        ]
        # The last counts are some clocks late.
        self.sync += If(working, linger.eq(31)).Elif(linger != 0, linger.eq(linger - 1))

        geometry_kept, raster_kept = Signal(4), Signal(7)
        # What a raymarcher beside the engine says and hears: see rtl/triangle/raster_unit.sv.
        self.field = field = Record([
            ("enable", 1), ("compose", 2), ("start", 1), ("restart", 1), ("size", 2), ("open", 1), ("done", 1), ("next", 1),
            ("valid", 1), ("ready", 1), *_FIELD_GROUP])
        self.comb += [field.restart.eq(self._control.fields.cancel), field.size.eq(raster_kept[:2])]
        link = {name: Signal() for name in (
            "ready", "geometry_start", "geometry_busy", "geometry_done", "mesh_error", "full",
            "raster_start", "raster_busy", "raster_done", "list_error")}
        cancel = self._control.fields.cancel
        self.comb += [
            *(port.rdata.ready.eq(1) for port in readers),
            *(port.cmd.we.eq(1) for port in writers),
        ]
        controlled = {"ready", "geometry_busy", "geometry_done", "mesh_error", "full", "raster_busy", "raster_done", "list_error"}
        self.specials += Instance("triangle_control", name="triangle_control",
            p_ADDRESS_BITS         = _ADDRESS_BITS,
            p_COUNT_BITS           = _COUNT_BITS,
            p_BASE                 = main_ram.origin,
            p_SMOOTH               = int(smooth),
            i_clk                  = ClockSignal("sys"),
            i_rst                  = ResetSignal("sys"),
            i_cancel               = cancel,
            i_geometry_ask         = self._geometry.fields.start,
            i_geometry_flags       = Cat(*(getattr(self._geometry.fields, name) for name in (
                                         "size", "cull", "smooth"))),
            o_recovering           = recovering,
            o_geometry_kept        = geometry_kept,
            o_geometry_active      = self._status.fields.geometry_busy,
            o_geometry_ended       = self.ev.geometry.trigger,
            o_geometry_error       = self._status.fields.geometry_error,
            i_mesh                 = self._mesh.storage,
            i_mesh_bytes           = self._mesh_bytes.storage,
            i_geometry_descriptors = self._geometry_descriptors.storage,
            i_descriptor_limit     = self._descriptor_limit.storage,
            i_geometry_lists       = self._geometry_lists.storage,
            i_list_shift           = self._list_shift.storage,
            i_exceptions           = self._exceptions.storage,
            i_exception_limit      = self._exception_limit.storage,
            i_raster_ask           = self._raster.fields.start,
            i_raster_flags         = Cat(*(getattr(self._raster.fields, name) for name in (
                                         "size", "first", "second", "depth", "slot", "whole"))),
            o_raster_kept          = raster_kept,
            o_raster_active        = self._status.fields.raster_busy,
            o_raster_ended         = self.ev.raster.trigger,
            o_raster_error         = self._status.fields.raster_error,
            i_frame                = self._frame.storage,
            i_depth                = self._depth.storage,
            **{f"i_{name}_{k}": getattr(self, f"_{name}_{k}").storage
               for name in ("lists", "descriptors", "count") for k in (0, 1)},
            **{f"{'i' if name in controlled else 'o'}_{name}": signal for name, signal in link.items()},
        )
        word = slice(4, 4 + _ADDRESS_BITS)
        mesh_last = Signal(_ADDRESS_BITS)
        self.sync += mesh_last.eq(self._mesh.storage[word] + self._mesh_bytes.storage[word] - 1)
        self.specials += Instance("triangle_engine", name="triangle_engine",
            p_ADDRESS_BITS         = _ADDRESS_BITS,
            p_COUNT_BITS           = _COUNT_BITS,
            p_SMOOTH               = int(smooth),
            p_FIELDS               = int(fields),
            i_clk                  = self.clk,
            i_rst                  = ResetSignal("sys"),
            i_cancel               = cancel,
            **{f"{'o' if name in controlled else 'i'}_{name}": signal
               for name, signal in link.items()},
            i_mesh_first           = self._mesh.storage[word],
            i_mesh_last            = mesh_last,
            i_geometry_descriptors = self._geometry_descriptors.storage[word],
            i_descriptor_limit     = self._descriptor_limit.storage,
            i_geometry_lists       = self._geometry_lists.storage[word],
            i_list_shift           = self._list_shift.storage,
            i_exception_base       = self._exceptions.storage[word],
            i_exception_limit      = self._exception_limit.storage,
            i_geometry_size        = geometry_kept[:2],
            i_cull_back            = geometry_kept[2],
            i_smooth               = geometry_kept[3],
            i_scale_shift          = self._scale_shift.storage,
            **{f"i_row_{row}": Cat(*values) for row, values in rows.items()},
            **{f"i_t{axis}": value for axis, value in translation.items()},
            i_near_z               = Cat(self._near_low.storage, self._near_high.storage),
            i_depth_mantissa       = self._depth_scale.fields.mantissa,
            i_depth_exponent       = self._depth_scale.fields.exponent,
            o_triangles            = status["triangles"].status,
            o_unseen_count         = status["unseen"].status,
            o_culled_count         = status["culled"].status,
            o_descriptors          = status["descriptor_count"].status[:_COUNT_BITS],
            o_exceptions           = status["exception_count"].status[:_COUNT_BITS],
            o_geometry_clocks      = status["cycles_geometry"].status,
            o_vertices             = status["vertices"].status,
            i_raster_size          = raster_kept[:2],
            i_present              = raster_kept[2:4],
            i_with_depth           = raster_kept[4],
            i_frame_slot           = raster_kept[5],
            i_whole                = raster_kept[6],
            i_frame_base           = self._frame.storage[word],
            i_depth_base           = self._depth.storage[word],
            i_clear                = self._clear.storage,
            i_raster_lists         = Cat(self._lists_0.storage[word], self._lists_1.storage[word]),
            i_raster_counts        = Cat(self._count_0.storage, self._count_1.storage),
            i_raster_descriptors   = Cat(self._descriptors_0.storage[word], self._descriptors_1.storage[word]),
            o_raster_clocks        = status["cycles_raster"].status,
            o_clocks_walking       = status["cycles_walking"].status,
            o_clocks_empty         = status["cycles_empty"].status,
            o_groups_in            = status["groups"].status,
            o_pixels_covered       = status["pixels_covered"].status,
            o_pixels_drawn         = status["pixels_drawn"].status,
            o_clocks_held          = status["cycles_held"].status,
            o_clocks_memory        = status["cycles_memory"].status,
            o_clocks_flush         = status["cycles_flush"].status,
            i_field                = field.enable,
            i_compose              = field.compose,
            o_field_start          = field.start,
            o_field_open           = field.open,
            i_field_done           = field.done,
            o_field_next           = field.next,
            i_field_valid          = field.valid,
            o_field_ready          = field.ready,
            **{f"i_field_{name}": getattr(field, name) for name, _ in _FIELD_GROUP},
            **_read_port("mesh_read", mesh_reader),
            **_read_port("vertex_read", vertex_reader),
            **_read_port("raster_read", raster_reader),
            **_write_port("descriptors", descriptor_writer),
            **_write_port("lists", list_writer),
            **_write_port("frame_even", even_writer),
            **_write_port("frame_odd", odd_writer),
        )
        reads_stalled = _any(port.cmd.valid & ~port.cmd.ready for port in readers)
        stalls = [reads_stalled, *(_any(port.cmd.valid & ~port.cmd.ready for port in some) for some in (writers[:2], writers[2:]))]
        self.sync += [
            If(link["geometry_busy"] | link["raster_busy"],
                status["cycles_busy"].status.eq(status["cycles_busy"].status + 1)),
            If(_any(stalls),
                status["cycles_stalled"].status.eq(status["cycles_stalled"].status + 1)),
            *(If(stall, status[name].status.eq(status[name].status + 1))
              for name, stall in zip(("stalled_reads", "stalled_lists", "stalled_frame"), stalls, strict=True)),
            # The controller answers one port at a time, and takes data from one.
            status["items_in"].status.eq(status["items_in"].status + _any(port.rdata.valid for port in readers)),
            status["items_out"].status.eq(status["items_out"].status + _any(
                port.wdata.valid & port.wdata.ready for port in writers)),
        ]
        add_sources(platform, "triangle_control", "triangle_engine")


def _any(signals):
    result = 0
    for signal in signals:
        result = signal | result
    return result


def _read_port(name, port):
    """The engine's read port `name` at a native port."""
    return {
        f"o_{name}_cmd_valid": port.cmd.valid,
        f"i_{name}_cmd_ready": port.cmd.ready,
        f"o_{name}_cmd_addr": port.cmd.addr,
        f"i_{name}_rdata_valid": port.rdata.valid,
        f"i_{name}_rdata": port.rdata.data,
    }


def _write_port(name, port):
    """The engine's write port `name` at a native port."""
    return {
        f"o_{name}_cmd_valid": port.cmd.valid,
        f"i_{name}_cmd_ready": port.cmd.ready,
        f"o_{name}_cmd_addr": port.cmd.addr,
        f"o_{name}_wdata_valid": port.wdata.valid,
        f"i_{name}_wdata_ready": port.wdata.ready,
        f"o_{name}_wdata": port.wdata.data,
        f"o_{name}_wdata_strobe": port.wdata.we,
    }
