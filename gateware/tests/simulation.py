"""Simulation of modules in Python by Migen's simulator, but with a module's statements compiled to Python functions: Migen interprets all
of them in each step, which takes eight times as long. A combinational statement runs when a signal that it reads or drives has changed."""

from collections import defaultdict
from itertools import count

from migen.fhdl.bitcontainer import value_bits_sign
from migen.fhdl.structure import Case, Cat, ClockSignal, Constant, If, Replicate, ResetSignal, Signal
from migen.fhdl.structure import _ArrayProxy, _Assign, _Operator, _Part, _Slice
from migen.fhdl.tools import group_by_targets
from migen.sim.core import Evaluator, Simulator

_NOW, _NEXT = "now[{0}]", "next.get({0}, now[{0}])"
"""Expressions of a signal with the given number: its value, and its value after the statements so far."""


class _Function:
    """A list of statements as a function `run` of the values of all signals and of a dictionary that receives their next values. `signals`
    are those that it reads or drives."""

    def __init__(self, statements, domains):
        self._domains, self._names, self._lines = domains, map("t{}".format, count()), ["def run(now, next):"]
        self.signals = set()
        self._block(statements, " ")
        names = {}
        exec("\n".join(self._lines), names)
        self.run = names["run"]

    def _block(self, statements, indent):
        """Adds the lines of statements."""
        self._lines.append(f"{indent}pass")
        for statement in statements:
            if isinstance(statement, _Assign):
                self._assign(statement.l, self._value(statement.r), indent)
            elif isinstance(statement, If):
                self._lines.append(f"{indent}if {_low_bits(self._value(statement.cond), len(statement.cond))}:")
                self._block(statement.t, indent + " ")
                self._lines.append(f"{indent}else:")
                self._block(statement.f, indent + " ")
            elif isinstance(statement, Case):
                test = self._variable(_truncated(self._value(statement.test), statement.test), indent)
                self._lines.append(f"{indent}if False: pass")
                for key, body in statement.cases.items():
                    if isinstance(key, Constant):
                        self._lines.append(f"{indent}elif {test} == {key.value}:")
                        self._block(body, indent + " ")
                self._lines.append(f"{indent}else:")
                self._block(statement.cases.get("default", ()), indent + " ")
            else:
                self._block(statement, indent)

    def _variable(self, value, indent):
        name = next(self._names)
        self._lines.append(f"{indent}{name} = {value}")
        return name

    def _assign(self, target, value, indent):
        """Adds the lines of an assignment."""
        if isinstance(target, Cat):
            value = self._variable(value, indent)
            for part in target.l:
                self._assign(part, value, indent)
                value = f"({value} >> {len(part)})"
        elif isinstance(target, (_Slice, _Part)):
            start = self._value(target.offset, _NEXT) if isinstance(target, _Part) else target.start
            start, width = self._variable(start, indent), len(target)
            kept = f"{self._value(target.value, _NEXT)} & ~({(1 << width) - 1} << {start})"
            self._assign(target.value, f"({kept} | {_low_bits(value, width)} << {start})", indent)
        elif isinstance(target, _ArrayProxy) and not _is_signal(target):
            index, value = self._variable(self._index(target), indent), self._variable(value, indent)
            for number, choice in enumerate(target.choices):
                self._lines.append(f"{indent}if {index} == {number}:")
                self._assign(choice, value, indent + " ")
        else:
            self._lines.append(f"{indent}next[{self._number(target)}] = {_truncated(value, target)}")

    def _number(self, node):
        """Returns the expression of the number of a signal, or of an element of an array of signals."""
        if isinstance(node, _ArrayProxy):
            return f"({', '.join(map(self._number, node.choices))},)[{self._index(node)}]"
        self.signals.add(node)
        return f"{node.duid}"

    def _index(self, node):
        return f"min({len(node.choices) - 1}, {self._value(node.key)})"

    def _value(self, node, signal=_NOW):
        """Returns the expression of a value; `signal` is that of a signal."""
        def value(part):
            return self._value(part, signal)

        if isinstance(node, Constant):
            return f"({node.value})"
        if _is_signal(node):
            return signal.format(self._number(node))
        if isinstance(node, ClockSignal):
            return value(self._domains[node.cd].clk)
        if isinstance(node, ResetSignal):
            return value(self._domains[node.cd].rst)
        if isinstance(node, _ArrayProxy):
            return f"({', '.join(map(value, node.choices))},)[{self._index(node)}]"
        if isinstance(node, _Slice):
            return _low_bits(f"({value(node.value)} >> {node.start})", len(node))
        if isinstance(node, _Part):
            return _low_bits(f"({value(node.value)} >> {value(node.offset)})", len(node))
        if isinstance(node, Cat):
            starts = [sum(map(len, node.l[:number])) for number in range(len(node.l))]
            return f"({' | '.join(f'{_low_bits(value(part), len(part))} << {start}' for part, start in zip(node.l, starts))})"
        if isinstance(node, Replicate):
            width = len(node.v)
            return f"({_low_bits(value(node.v), width)} * {sum(1 << width * number for number in range(node.n))})"
        assert isinstance(node, _Operator), node
        operands = [value(operand) for operand in node.operands]
        if node.op == "m":
            return "({1} if {0} else {2})".format(*operands)
        operator = {">>>": ">>", "<<<": "<<"}.get(node.op, node.op)
        return f"({operator}{operands[0]})" if len(operands) == 1 else f"({operands[0]} {operator} {operands[1]})"


def _is_signal(node):
    """Returns whether a node is a signal, or an element of an array of signals."""
    return isinstance(node, Signal) or isinstance(node, _ArrayProxy) and all(isinstance(choice, Signal) for choice in node.choices)


def _low_bits(value, width):
    return f"({value} & {(1 << width) - 1})"


def _truncated(value, node):
    """Returns the expression of a value with the width and the sign of a node."""
    width, is_signed = value_bits_sign(node)
    half = is_signed << width >> 1
    return f"{_low_bits(f'({value} + {half})', width)} - {half}" if is_signed else _low_bits(value, width)


class _Evaluator(Evaluator):
    """Executes functions in place of lists of statements."""

    def execute(self, statements):
        for function in statements:
            if isinstance(function, _Function):
                function.run(self.signal_values, self.modifications)
            else:
                super().execute([function])


class _Simulator(Simulator):
    """Migen's simulator with compiled statements."""

    def __init__(self, *arguments, **options):
        super().__init__(*arguments, **options)
        fragment, self._readers = self.fragment, defaultdict(list)
        self.evaluator = _Evaluator(fragment.clock_domains, self.evaluator.replaced_memories)
        fragment.comb = [_Function(group, fragment.clock_domains) for _, group in group_by_targets(fragment.comb)]
        fragment.sync = {name: [_Function(statements, fragment.clock_domains)] for name, statements in fragment.sync.items()}
        for function in fragment.comb:
            for signal in function.signals:
                self._readers[signal.duid].append(function)
        for function in [*fragment.comb, *(function for functions in fragment.sync.values() for function in functions)]:
            for signal in function.signals:
                self.evaluator.signal_values[signal.duid] = signal.reset.value

    def _commit_and_comb_propagate(self):
        while changed := self.evaluator.commit_set():
            self.evaluator.execute({function for number in changed for function in self._readers[number]})


def run_simulation(*arguments, **options):
    """Simulates a module; the parameters are those of Migen's function."""
    with _Simulator(*arguments, **options) as simulator:
        simulator.run()
