"""Test of the memory commands of the CPU: compares the injector with LiteDRAM's."""

import random

from litedram.dfii import DFIInjector
from migen import Cat, Module
from migen.genlib.record import DIR_M_TO_S

from crossbar import connect
from glint_soc.memory_crossbar import MemoryCrossbar
from glint_soc.memory_injector import MemoryInjector
from simulation import run_simulation

_ADDRESS, _BANK, _DATA, _PHASES = 13, 3, 32, 4


def _fields(*registers):
    """Pairs the fields of registers of equal layout."""
    return zip(*([getattr(register.fields, field.name) for field in register.fields.fields] for register in registers), strict=True)


class _Both(Module):
    """LiteDRAM's injector and this project's, with their inputs in pairs. No register bank is connected, so the test drives the registers'
    fields."""

    def __init__(self):
        self.submodules.expected = expected = DFIInjector(_ADDRESS, _BANK, 1, _DATA, _PHASES)
        self.submodules.injector = injector = MemoryInjector(_ADDRESS, _BANK, _DATA, _PHASES)
        self.sel = injector._control.fields.sel
        self.inputs, self.commands = [*_fields(expected._control, injector._control)], []
        for number in range(_PHASES):
            pair = [getattr(one, f"pi{number}") for one in (expected, injector)]
            self.inputs += _fields(*(one._command for one in pair))
            for name in ("_address", "_baddress", "_wrdata"):
                self.inputs.append(tuple(getattr(one, name).storage for one in pair))
            self.inputs.append(tuple(one._command_issue.re for one in pair))
            slaves, masters = ([getattr(one, side).phases[number] for one in (expected, injector)] for side in ("slave", "master"))
            self.inputs += [tuple(getattr(phase, name) for phase in masters) for name in ("rddata", "rddata_valid")]
            for name, _, direction in slaves[0].layout:
                if direction == DIR_M_TO_S:
                    self.inputs.append(tuple(getattr(phase, name) for phase in slaves))
                    if name not in ("wrdata", "wrdata_mask"):
                        self.commands.append(tuple(getattr(phase, name) for phase in masters))


def _words(injector, side, name):
    return Cat(*(getattr(phase, name) for phase in getattr(injector, side).phases))


def test_commands_and_data():
    """Checks commands, data in both directions and the read data in the registers, with random inputs of both injectors."""
    rng, both = random.Random(1), _Both()
    different, injected = set(), 0

    def run():
        nonlocal injected
        for _ in range(1000):
            for expected, own in both.inputs:
                value = rng.getrandbits(len(expected))
                yield expected.eq(value)
                yield own.eq(value)
            yield
            sel = yield both.sel
            injected += not sel
            pairs = [*both.commands]
            # While the registers inject commands, this project's injector outputs their write data as `words`, which the
            # crossbar sends; LiteDRAM's drives them on `master`.
            pairs.append((_words(both.expected, "master", "wrdata"), both.injector.words if not sel
                          else _words(both.injector, "master", "wrdata")))
            if sel:
                pairs.append(tuple(_words(one, "slave", "rddata") for one in (both.expected, both.injector)))
            pairs.append(tuple(_words(one, "slave", "rddata_valid") for one in (both.expected, both.injector)))
            pairs += [tuple(getattr(one, f"pi{number}")._rddata.status for one in (both.expected, both.injector))
                      for number in range(_PHASES)]
            for place, (expected, own) in enumerate(pairs):
                if (yield expected) != (yield own):
                    different.add(place)

    run_simulation(both, run())
    assert not different
    assert 300 < injected < 700


def test_the_crossbar_sends_the_words():
    """Checks that the crossbar sends the words of the registers while the registers inject commands, and the words of a port otherwise."""
    injector = MemoryInjector(_ADDRESS, _BANK, 8, 2)
    crossbar, controller, ports = connect(lambda interface: MemoryCrossbar(interface, injector), ("both", "read", "write", "write"),
                                          (4, 3), 8, 16, 4, 2)
    found = []

    def run():
        for phase, word in ((injector.pi0, 0xcd), (injector.pi1, 0xab)):
            yield phase._wrdata.storage.eq(word)
        yield ports[0].wdata.data.eq(0x1234)
        for sel in (0, 1):
            yield injector._control.fields.sel.eq(sel)
            yield
            yield
            found.append(((yield controller.wdata), (yield controller.wdata_we)))

    top = Module()
    top.submodules += crossbar, injector
    run_simulation(top, run())
    assert found == [(0xabcd, 0b11), (0x1234, 0)]
