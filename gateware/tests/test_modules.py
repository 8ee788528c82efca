"""Tests of the RTL modules: lint, and whether Yosys reads them. Also builds the models for the tests in `tools/testbench`."""

import shutil

import pytest

import memory_machine
from resources.modules import RTL_MODULES
from resources.tools import BUILD, run_yosys
from verilate import module as verilated_module
from verilate.programs import run_verilator

_BUILDS = [pytest.param(module, name, parameters, id=name) for module in RTL_MODULES for name, parameters in module.builds().items()]

# Modules that are parts of another module under test. Yosys reads them together with that module.
_PARTS = {source.stem for module in RTL_MODULES for source in module.sources if source.stem != module.top}
_WHOLE = [module for module in RTL_MODULES if module.top not in _PARTS]


@pytest.fixture(scope="module", autouse=True)
def _no_other_models():
    """Deletes models that are no longer built, so that a test that still uses one fails here too, and not only in a fresh clone."""
    names = {name for module in RTL_MODULES for name in module.builds() if name not in module.measured} | {memory_machine.NAME}
    for path in verilated_module.MODELS.glob("*"):
        if path.stem not in names:
            # Several processes of the test run may delete the same model.
            shutil.rmtree(path, ignore_errors=True) if path.is_dir() else path.unlink(missing_ok=True)


@pytest.mark.parametrize(("module", "name", "parameters"), _BUILDS)
def test_model(module, name, parameters):
    """Builds the model of a module, with all warnings of Verilator as errors; a build that is only measured is checked for warnings."""
    if name in module.measured:
        run_verilator("--lint-only", "-Wall", "--top-module", module.top,
                      *(f"-G{key}={value}" for key, value in parameters.items()), *module.sources)
    else:
        verilated_module.build(module.top, module.sources, name, parameters)


def test_model_of_the_memory():
    """Builds the model of the path to main memory from LiteX's Verilog."""
    source = memory_machine.write(verilated_module.MODELS.parent / memory_machine.NAME)
    verilated_module.build(memory_machine.NAME, [source], memory_machine.NAME, {}, warnings=("-Wno-fatal", "-Wno-lint"))


@pytest.mark.parametrize("module", _WHOLE, ids=lambda module: module.top)
def test_read_by_yosys(module):
    """Checks that Yosys can read all builds of a module, with their parts. Parts that several builds have in common are checked once."""
    values = ((name, ", ".join(f".{key}({value})" for key, value in parameters.items())) for name, parameters in module.builds().items())
    instances = "\n".join(f"{module.top} #({parameters}) {name} ();" for name, parameters in values)
    BUILD.mkdir(parents=True, exist_ok=True)
    builds = BUILD / f"builds_of_{module.top}.sv"
    builds.write_text(f"module builds;\n{instances}\nendmodule\n")
    run_yosys("hierarchy -check -top builds; proc; check -assert", [*module.sources, builds])
