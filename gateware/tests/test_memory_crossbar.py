"""Tests of the crossbar of the memory: random traffic from several ports, and a model of the bank machines."""

import random
from collections import deque

import pytest
from migen import passive

from crossbar import connect
from glint_soc.memory_crossbar import MemoryCrossbar
from simulation import run_simulation

_BANKS = 4
_COLUMNS = 16
_WORDS = 2 * _BANKS * _COLUMNS
"""Number of words of the memory, in two rows; it is small, so that accesses overlap."""

_BITS = 16
_DEPTH = 8
_CYCLES = 3000


class _Memory:
    """Model of the bank machines: a queue of commands for each bank. In each clock at most one command completes, with
    probability `rate`. Its write or read data are transferred some clocks later."""

    def __init__(self, controller, rng, rate):
        self.controller, self.rng, self.rate = controller, rng, rate
        self.words = {}

    @passive
    def run(self):
        """Runs the bank machines."""
        controller, rng = self.controller, self.rng
        banks = [getattr(controller, f"bank{number}") for number in range(_BANKS)]
        queues = [deque() for _ in banks]
        # Signals written by the simulation change one clock later, and the crossbar adds a clock to both latencies.
        # Commands take effect when the data of writes have arrived.
        phy = controller.settings.phy
        commands = deque([(False, None)] * (phy.write_latency + 2))
        reads = deque([0] * (phy.read_latency - phy.write_latency - 1))
        while True:
            for number, bank in enumerate(banks):
                if (yield bank.valid):
                    queues[number].append(((yield bank.we), (yield bank.addr)))
                    if len(queues[number]) > _DEPTH + 1:
                        raise AssertionError(f"bank {number}: a command arrived while the queue was full")
                yield bank.wdata_ready.eq(0)
                yield bank.rdata_valid.eq(0)
            is_write, place = commands.popleft()
            if is_write:
                self.words[place] = (yield controller.wdata)
            reads.append(self.words.get(place, 0) if place is not None and not is_write else rng.getrandbits(_BITS))
            yield controller.rdata.eq(reads.popleft())
            done = False, None
            filled = [number for number in range(_BANKS) if queues[number]]
            if filled and rng.random() < self.rate:
                number = rng.choice(filled)
                is_write, address = queues[number].popleft()
                done = is_write, address % _COLUMNS + _COLUMNS * (number + _BANKS * (address // _COLUMNS))
                yield (banks[number].wdata_ready if is_write else banks[number].rdata_valid).eq(1)
            commands.append(done)
            yield


def _clients(ports, rng, pause, counts):
    """Sends commands to all ports, and compares read data with the data written before, in the order in which the crossbar
    accepted the commands."""
    written, expected, data = {}, [deque() for _ in ports], [deque() for _ in ports]
    for cycle in range(_CYCLES + 100):
        for number, port in enumerate(ports):
            if (yield port.cmd.valid) and (yield port.cmd.ready):
                counts[number] += 1
                address = (yield port.cmd.addr)
                if (yield port.cmd.we):
                    written[address] = rng.getrandbits(_BITS)
                    data[number].append(written[address])
                else:
                    expected[number].append(written.get(address, 0))
                yield port.cmd.valid.eq(0)
            if (yield port.rdata.valid):
                word = (yield port.rdata.data)
                if not expected[number] or word != expected[number].popleft():
                    raise AssertionError(f"port {number} read {word:#x} in cycle {cycle}, not what was written before")
            if (yield port.wdata.ready):
                if not data[number]:
                    raise AssertionError(f"port {number}: data were taken without a pending write command")
                data[number].popleft()
            yield port.wdata.data.eq(data[number][0] if data[number] else rng.getrandbits(_BITS))
            idle = not (yield port.cmd.valid) or (yield port.cmd.ready)
            if idle and cycle < _CYCLES and rng.random() >= pause:
                yield port.cmd.valid.eq(1)
                yield port.cmd.we.eq({"both": rng.getrandbits(1), "read": 0, "write": 1}[port.mode])
                # Consecutive addresses are likely, as in the blocks' streams.
                yield port.cmd.addr.eq(((yield port.cmd.addr) + 1 if rng.random() < 0.8 else rng.getrandbits(8)) % _WORDS)
        yield
    left = [len(queue) for queue in (*expected, *data)]
    if any(left):
        raise AssertionError(f"words left at the end, reads and writes by port: {left}")


def _run(modes, latencies, rate, pause):
    """Runs random traffic and returns the number of commands by port."""
    rng = random.Random(1)
    crossbar, controller, ports = connect(MemoryCrossbar, modes, latencies, _DEPTH, _BITS, column_bits=4, bank_bits=2)
    counts = [0] * len(ports)
    run_simulation(crossbar, [_clients(ports, rng, pause, counts), _Memory(controller, rng, rate).run()])
    return counts


@pytest.mark.parametrize("latencies", [(4, 0), (9, 1)])
def test_random_traffic(latencies):
    """Checks that each port gets its data in order, that reads see all earlier writes, and that no port starves."""
    assert min(_run(("both", "read", "read", "write", "write"), latencies, 0.7, 0.3)) >= _CYCLES // 40, "commands by port"


def test_command_a_clock():
    """Checks that a single active port sends a command in nearly every clock while it stays in a bank."""
    count, = _run(("both",), (4, 0), 1, 0)
    assert count > 0.5 * _CYCLES
