"""Every example runs and says what it should."""

from __future__ import annotations

import json
import re
import runpy
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial import cKDTree

import fyke
from fyke.case import load_cases_of
from fyke.forces.evaluate import evaluate
from fyke.results import by_part

EXAMPLES = Path(__file__).parent.parent / "examples"


@pytest.mark.parametrize("case", sorted(EXAMPLES.glob("*.toml")), ids=lambda p: p.stem)
def test_case_runs(case, tmp_path):
    command = [
        sys.executable,
        "-m",
        "fyke",
        "run",
        str(case),
        "-o",
        str(tmp_path / "out"),
        "--json",
        "--no-figures",
    ]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    summary = json.loads(done.stdout)
    # A net in waves never comes to rest: its run is over when its time is.
    assert summary["outcome"] == ("completed" if "waves" in summary else "converged")
    # Ropes float, and water goes to and fro past a collar by a few diameters, which the examples say.
    assert all("floats" in one or "Keulegan" in one for one in summary["warnings"]), summary["warnings"]
    if "waves" in summary:
        return
    bed = summary.get("bed_force", [0.0, 0.0, 0.0])
    held = [
        q + (summary["weight_in_water"] if i == 2 else 0.0) - bed[i]
        for i, q in enumerate(summary["support_reaction"])
    ]
    assert held == pytest.approx(summary["hydrodynamic_force"], abs=1e-4)


def test_hanging_line_agrees_with_the_exact_curve():
    """Excursion, depth and top tension of the inextensible line, from its differential equation."""
    out = subprocess.run(
        [sys.executable, EXAMPLES / "hanging_line.py"], capture_output=True, text=True, check=True
    )
    exact = {
        0.1: (0.04351329, 0.99874708, 0.20969658),
        0.3: (0.34586977, 0.91886658, 0.20932930),
        0.5: (0.64247886, 0.69921680, 0.21036078),
        1.0: (0.89226931, 0.33383891, 0.22821804),
    }
    lines = re.findall(
        r"([\d.]+) m/s: end at x = ([\d.]+) m, z = -([\d.]+) m, top tension ([\d.]+) N", out.stdout
    )
    assert len(lines) == len(exact)
    for speed, *values in lines:
        assert [float(v) for v in values] == pytest.approx(exact[float(speed)], abs=1.5e-3)


def solved(name):
    case = fyke.load_case(EXAMPLES / f"{name}.toml")
    net = fyke.build_net(case)
    result = fyke.solve_static(fyke.build_system(net, case))
    assert result.outcome.ok
    return net, result


def test_diamond_netting_bears_along_its_sides_and_square_netting_does_not():
    """What is told of Li et al. 2006: diamond netting bears most along the four sides of its frame, least inside.

    A square panel held all round is two families of strings that cross: those through the middle bear most, and each
    bears much the same all along, for nothing but the drag along a bar acts along it.
    """
    net, result = solved("square_and_diamond")
    tension = result.tension[-1]
    means = {}
    for panel in net.panels:
        bars = panel.bars[:, 0]
        places = net.positions[net.bars[bars]].mean(axis=1) - net.positions[panel.knots].mean(axis=0)
        out = np.abs(places[:, 1:]).max(axis=1)  # m from the middle, of 0.5 m
        own = tension[bars]
        means[panel.name] = [own[out > 0.4].mean(), own[out < 0.25].mean()]
        most = np.argsort(-own)[: len(own) // 10]
        if panel.name == "diamond":
            assert np.mean(out[most] > 0.4) > 0.5
    assert means["diamond"][0] > 1.1 * means["diamond"][1]
    assert means["square"][0] < 0.5 * means["square"][1]
    square = net.panels[0]
    grid = square.lattice
    ends = grid.knots[grid.bars]
    string = tension[square.bars[(ends[:, :, 0] == 10).all(axis=1), 0]]
    assert np.ptp(string) < 0.15 * string.max()


def test_the_model_cage_keeps_what_it_says():
    """Twine, weight and drag area of the real netting by hand: bars of 25.5 mm, twine of 2.42 mm, sinkers of 5.15 N."""
    case = fyke.load_case(EXAMPLES / "model_cage.toml")
    system = fyke.build_system(fyke.build_net(case), case)
    loland = 0.04 + (-0.04 + 0.194 - 1.24 * 0.194**2 + 13.7 * 0.194**3)
    assert 1.0 - 0.46 * loland == pytest.approx(0.886, abs=5e-4)
    assert system.net.panels[0].meshes == (72, 20)
    twine = 25.5e-3 * (216 * 61 + 216 * 60)
    weight = 9.81 * 140.0 * np.pi / 4 * 2.42e-3**2 * twine + 16 * 5.15
    assert system.weight_in_water == pytest.approx(weight, rel=1e-10)
    el = system.elements
    assert 2.0 * (el.normal_drag * el.rest_length).sum() == pytest.approx(
        500.0 * 1.2 * 2.42e-3 * twine, rel=1e-10
    )


def test_the_gillnet_stands_for_its_real_meshes():
    """3640 x 104 meshes in at most 5 000 knots: weight of twine, knots, ropes, floats and leads by hand."""
    case = fyke.load_case(EXAMPLES / "gillnet.toml")
    system = fyke.build_system(fyke.build_net(case), case)
    net = system.net
    assert net.knot_count <= 5000 and net.panels[0].real_meshes == (3640, 104)
    knots = 2 * 3640 * 104 + 3640 + 104 + 1
    fibre = np.pi / 4 * 0.3e-3**2 * 27.5e-3 * 4 * 3640 * 104 + np.pi / 6 * 0.75e-3**3 * knots
    ropes = np.pi / 4 * 8e-3**2 * 2 * 100.1
    weight = 9.81 * ((1140.0 - 1025.0) * fibre - (1025.0 - 910.0) * ropes) - 101 * 0.8 + 401 * 0.25
    assert system.weight_in_water == pytest.approx(weight, rel=1e-9)


def test_the_sinker_bars_of_the_sheets_weigh_what_was_computed():
    """A solid bar of 0.3 m, 6 mm and 8610 kg/m3 weighs 0.6332 N in fresh water; the drag of the back sheet is less."""
    case = fyke.load_case(EXAMPLES / "b01_sheet.toml")
    system = fyke.build_system(fyke.build_net(case), case)
    result = fyke.solve_static(system)
    assert result.outcome.ok
    parts = {part.name: part for part in by_part(system, result)}
    for bar in ("front bar", "back bar"):
        assert parts[bar].weight_in_water == pytest.approx(0.6332, abs=5e-5)
    assert parts["back"].drag < 0.95 * parts["front"].drag


def test_the_cage_at_seven_speeds_is_the_one_of_the_set_up():
    case = fyke.load_case(EXAMPLES / "c01_cage.toml")
    speeds = [one.current.at_surface[0] for _, _, one in load_cases_of(case)]
    assert speeds == pytest.approx([0.12, 0.26, 0.39, 0.50, 0.65, 0.76, 0.93])
    system = fyke.build_system(fyke.build_net(case), case)
    twine = 25.5e-3 * (216 * 61 + 216 * 60)
    weight = 9.81 * 140.0 * np.pi / 4 * 2.42e-3**2 * twine + 16 * 5.15
    assert system.weight_in_water == pytest.approx(weight, rel=1e-10)


def test_cages_by_mesh_and_size_are_printed_and_drawn(tmp_path):
    """In still water square netting keeps its volume; the deep cage has more drag and keeps less volume."""
    picture = tmp_path / "curves.png"
    command = [sys.executable, EXAMPLES / "mesh_and_size.py", "--figure", picture]
    out = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    rows = [[float(v) for v in line.split()] for line in out.splitlines() if re.match(r" +0\.\d ", line)]
    shallow, deep = np.array(rows).reshape(2, 6, 10)
    for cage in (shallow, deep):
        assert cage[:, 0] == pytest.approx([0.0, 0.1, 0.3, 0.5, 0.7, 0.9])
        assert cage[0, [1, 4, 7]] == pytest.approx(0.0, abs=1e-9)
        assert np.all(np.diff(cage[:, [1, 4, 7]], axis=0) > 0.0)
        assert cage[0, 2] == pytest.approx(100.0, abs=0.5)
    assert np.all(deep[1:, [1, 4, 7]] > shallow[1:, [1, 4, 7]])
    assert np.all(deep[2:, [2, 5, 8]] < shallow[2:, [2, 5, 8]])
    assert picture.stat().st_size > 10_000


@pytest.mark.parametrize("size", ["shallow", "deep"])
@pytest.mark.parametrize("mesh", ["square", "diamond", "hexagonal"])
def test_cages_by_mesh_and_size_have_one_volume_one_weight_and_the_drag_of_their_bars(mesh, size):
    """Volume, weight in water and drag as built by hand.

    A bar that leans by an angle b from the upright on the wall, at t round from the current, has e.x = -sin b sin t.
    """
    made = runpy.run_path(str(EXAMPLES / "mesh_and_size.py"))
    diameter, depth = made["SIZES"][size]
    case = made["case_of"](mesh, size, 0.5)
    net = fyke.build_net(case)
    laid = made["MESHES"][mesh](np.pi * diameter, depth)
    assert np.pi / 4 * diameter**2 * depth == pytest.approx(0.3720, abs=5e-4)
    bars = np.unique(net.panels[0].bars)  # its first column is its last
    netting, ropes = net.rest_length[bars].sum(), 8 * depth
    assert netting * made["BAR"] / 2 == pytest.approx(np.pi * diameter * depth, rel=0.045)
    hung = np.pi / 4 * 9.81 * (115.0 * 2e-3**2 * netting + 355.0 * 4e-3**2 * ropes)
    assert fyke.build_system(net, case).weight_in_water == pytest.approx(40.0 + hung, rel=2e-3)

    t = 2.0 * np.pi * (np.arange(10_000) + 0.5) / 10_000
    if mesh == "square":
        ring = laid.around * diameter * np.sin(np.pi / laid.around)
        leaning, length = [0.0, 0.5 * np.pi], [laid.around * depth, (laid.down + 1) * ring]
    elif mesh == "diamond":
        leaning, length = [np.arcsin(np.pi * diameter / laid.around / 2.0 / laid.bar)], [netting]
    else:
        slanted = 2 * laid.around * (laid.down + 1) * laid.bar
        leaning, length = [np.pi / 3.0, 0.0], [slanted, netting - slanted]
    drag = 0.0
    for b, whole in zip(leaning, length, strict=True):
        along = np.sin(b) * np.sin(t)
        each = 1.2 * (1.0 - along**2) ** 1.5 + 0.1 * np.abs(along) ** 3
        drag += 0.5 * 1025.0 * 2e-3 * 0.5**2 * whole * each.mean()
    alone = fyke.make_system(net, current=(0.5, 0.0, 0.0), water=fyke.Water(density=1025.0))
    frame = evaluate(alone, fyke.State(0.0, net.positions, np.zeros_like(net.positions)))
    assert frame.bar_drag[bars].sum() == pytest.approx(drag, rel=3e-3)


def test_a_cage_of_diamonds_hangs_as_its_mirror_image():
    made = runpy.run_path(str(EXAMPLES / "mesh_and_size.py"))
    result = made["answers"]("diamond", "shallow", (0.5,))[0].result
    net, mirror = result.net, np.array([1.0, -1.0, 1.0])
    other = cKDTree(net.positions).query(mirror * net.positions)
    assert other[0].max() < 1e-9
    assert np.abs(result.position[-1][other[1]] - mirror * result.position[-1]).max() < 5e-5  # m
