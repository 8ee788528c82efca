"""Tests of the figures of the pages. The tests of the crate run this file."""

import unittest
from pathlib import Path

import numpy as np
import pandas as pd

import figures
import state
import tables


class Timeline(unittest.TestCase):
    def test_the_longest_part_limits_a_frame_or_what_limits_this_part(self):
        for core, geometry, raster, refused, evaluations, expected in [
            (500, 300, 200, 0, np.nan, "soft core"),
            (200, 500, 300, 0, np.nan, "geometry"),
            (200, 300, 500, 0, np.nan, "raster"),
            (200, 300, 500, 401, np.nan, "memory"),
            (200, 300, 500, 400, np.nan, "raster"),
            (500, 300, 200, 401, np.nan, "soft core"),
            (200, 300, 500, 401, 502, "evaluations"),
            (200, 300, 500, 0, 500, "raster"),
        ]:
            frame = {"scene": "lamp", "cycles": 1000, "soft_core": core, "geometry": geometry, "raster": raster, "refused": refused,
                     "evaluations": evaluations}
            found = figures.timeline(pd.DataFrame([frame]), 2).iloc[0]
            self.assertEqual(found.bottleneck, expected, frame)
        rates = found[["rate", "rate_halved", "rate_without", "rate_overlapped"]].astype(float)
        self.assertEqual((figures.CLOCK / rates).round().tolist(), [1000, 750, 500, 800])


class Cores(unittest.TestCase):
    CELLS = pd.DataFrame([("full", 80.0, 3000), ("small", 100.0, 2000), ("slow", 40.0, 1000), ("large", 160.0, 4000), ("worse", 80.0, 3500)],
                         columns=["variant", "mhz", "lut"])
    FRAMES = pd.DataFrame([(variant, features, scene, factor * cycles) for variant, features, factor in [
        ("full", np.nan, 1), ("small", "uptime", 2), ("slow", "uptime", 4), ("large", np.nan, 1), ("worse", np.nan, 1), ("full", "uptime", 3)]
        for scene, cycles in [("lamp", 8000), ("room", 80000)]], columns=["variant", "features", "scene", "soft_core"]).assign(cycles=100000)

    def test_times_are_at_the_variants_own_clock(self):
        found = figures.cores(self.CELLS, self.FRAMES).set_index("variant")
        self.assertEqual(found["lamp ms"].round(6).tolist(), [0.1, 0.16, 0.8, 0.05, 0.1])
        self.assertEqual(found.cycles.round(6).tolist(), [1, 2, 4, 1, 1])
        self.assertEqual(found.time.round(6).tolist(), [1, 1.6, 8, 0.5, 1])
        self.assertEqual(found.index[found.shipped].tolist(), ["full"])

    def test_a_variant_without_a_clock_rate_has_cycles_alone(self):
        found = figures.cores(self.CELLS[self.CELLS.variant != "slow"], self.FRAMES).set_index("variant").loc["slow"]
        self.assertAlmostEqual(found.cycles, 4)
        self.assertTrue(np.isnan(found.time))

    def test_what_is_larger_and_slower_is_behind_the_front(self):
        found = figures.cores(self.CELLS, self.FRAMES).set_index("variant")
        self.assertEqual(found.family.tolist(), ["Pareto front"] * 4 + ["worse"])

    def test_the_cost_of_a_missing_counter_is_that_of_the_default_variant(self):
        found = figures.counterless(self.FRAMES)
        self.assertAlmostEqual(found["mean"], 3)
        self.assertAlmostEqual(found["largest"], 2)


class Qualities(unittest.TestCase):
    def test_a_better_quality_takes_more_cycles_for_smaller_errors(self):
        frames = figures.qualities(*(tables.read(tables.COMMITTED, name) for name in ("quality", "quality-cycles")))
        for scene, levels in frames.groupby("scene"):
            levels = levels.set_index("quality").loc[["fast", "balanced", "exact"]]
            for column, is_ordered in [("cycles", 1), ("wrong", -1), ("colour", -1)]:
                self.assertTrue((is_ordered * levels[column].diff()[1:] > 0).all(), f"{scene}: {column}")


class Antialiasing(unittest.TestCase):
    def test_the_last_row_is_the_rms_and_that_of_edges_leaves_out_lines(self):
        rows = [(scene, samples, dithered, factor / samples, 10 * factor / samples, 0.1)
                for scene, factor in [("lamp", 1), ("room", 7), ("wireframe", 5)] for samples in (1, 4) for dithered in (True, False)]
        columns = ["scene", "samples", "dithered", "colour", "edges", "share"]
        found = tables.rows(figures.antialiasing(pd.DataFrame(rows, columns=columns)))[-1]
        self.assertEqual([found[name] for name in ("scene", "colour_1", "colour_4_off", "edges_1", "edges_4_off")],
                         ["all", 5, 1.25, 50, 12.5])

    def test_the_centre_is_the_grid_of_one_sample(self):
        rows = [(scene, pattern, samples, factor, factor, False) for pattern, samples in [("centre", 1), ("grid", 4), ("rotated grid", 4)]
                for scene, factor in [("lamp", 1), ("room", 7), ("wireframe", 5)]]
        found = figures.patterns(pd.DataFrame(rows, columns=["scene", "pattern", "samples", "colour", "edges", "shipped"]))
        self.assertEqual(found.family.tolist(), ["grid", "grid", "rotated grid"])
        self.assertEqual((found.colour.tolist(), found.edges.tolist()), ([5] * 3, [5] * 3))


class Raymarcher(unittest.TestCase):
    def test_targets_are_of_the_slowest_view(self):
        rates = tables.read(tables.COMMITTED, "raymarch-rates").iloc[:2].assign(view=["aside", "amid"], cycles_frame=[1e6, 2e6])
        marching = rates.drop(columns="commit").rename(columns={"field": "scene"}).assign(cones=False, cycles=[4e6, 3e6])
        scenes = pd.DataFrame([(name, width, 1e6) for name, _, width, *_ in figures.SCENES], columns=["scene", "width", "cycles"])
        found = list(figures.targets(rates, scenes, marching))
        self.assertEqual(len(found), 1 + len(figures.SCENES))
        of_rates = [figures.CLOCK / found[0][name] if found[0][name] else None for name in ("marching", "cones", "exits")]
        self.assertEqual(of_rates, [4e6, None, 2e6])
        self.assertEqual((found[1]["marching"], found[1]["exits"]), (None, figures.CLOCK / 1e6))

    def test_each_picture_by_exits_has_its_marching_picture(self):
        columns = ["form", "scene", "view", "width", "evaluations"]
        pictures = pd.DataFrame([("exits", "a", "aside", 320, 1), ("marching", "b", "aside", 320, 7)], columns=columns)
        found = figures.beside(pictures, pd.DataFrame([("a", "aside", 320, 9)], columns=columns[1:]))
        self.assertEqual(found[["scene", "evaluations", "marching_evaluations"]].to_numpy().tolist(), [["a", 1, 9]])


class Index(unittest.TestCase):
    CHOICES = pd.DataFrame(
        [("cheapest", 1e-1, 1), ("cheap", 1e-2, 5), ("own", 1e-3, 10), ("worse", 1e-2, 20), ("better", 1e-4, 30), ("best", 1e-6, 40),
         ("unmeasured", 1e-5, np.nan)], columns=["config", "error", "cost"],
    ).assign(name="a kernel", shipped=lambda choices: choices.config == "own", in_overview=True)

    def test_neighbours_are_the_next_ones_on_each_side(self):
        choices = tables.rows(self.CHOICES)
        for place, expected in [(2, ["cheap", "better"]), (0, [None, "cheap"]), (5, ["better", None]), (4, ["own", "best"])]:
            near = figures.neighbours(choices, choices[place])
            self.assertEqual([choice and choice["config"] for choice in near], expected)

    def test_the_diagram_leaves_out_what_another_choice_beats(self):
        self.assertEqual(len(figures.overview(self.CHOICES)), 5)


class State(unittest.TestCase):
    def test_each_committed_table_is_declared_once(self):
        declared = [name for *_, names in state.MEASURED for name in names.split()]
        self.assertEqual(sorted(declared + state.WITHOUT_COMMIT), sorted(path.stem for path in tables.COMMITTED.glob("*.csv")))
        for name in declared:
            self.assertIn("commit", tables.read(tables.COMMITTED, name), name)

    def test_commands_are_jobs_and_sources_exist(self):
        jobs = (tables.ROOT / "tools/reference/workflow/Snakefile").read_text()
        for command, sources, names in state.MEASURED:
            self.assertTrue(command is None or f'("{command}",' in jobs, command)
            self.assertLessEqual(set(sources.split()), state.SOURCES.keys(), names)
        for path in sum(state.SOURCES.values(), []):
            self.assertTrue(path.startswith(":(") or (tables.ROOT / path.removeprefix(":!")).exists(), path)

    def test_sources_belong_to_the_commit_of_a_table(self):
        measured = (tables.ROOT / "tools/reference/src/report/provenance.rs").read_text()
        for path in sum(state.SOURCES.values(), []):
            if not path.startswith(":"):
                folders = [Path(path), *Path(path).parents]
                self.assertTrue(any(f'"{folder}",' in measured for folder in folders), path)

    def test_a_commit_that_git_lacks_is_unknown(self):
        self.assertEqual(state.since("0123456789ab-dirty", "RTL"), "unknown")


class Formats(unittest.TestCase):
    def test_numbers(self):
        self.assertEqual([tables.sci(1.26e-10, 1), tables.sci(5e-4), tables.sci(0.0, 2)], ["1.3e-10", "5e-4", "0.00e0"])
        self.assertEqual(tables.sci(None, 1, "none"), "none")
        self.assertEqual([tables.shown(value) for value in (1e-5, 81.25, 100.0, None)], ["0.00001", "81.25", "100", ""])


if __name__ == "__main__":
    unittest.main()
