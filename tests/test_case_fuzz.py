"""No text makes the reader fail with anything but a CaseError."""

from pathlib import Path

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from fyke.case import Case, CaseError, parse_case, template

EXAMPLE = (Path(__file__).parents[1] / "examples" / "panel.toml").read_text()
LINES = [line for line in template().splitlines() if "=" in line or line.startswith("[")]
VALUES = [
    "-1",
    "0",
    "1e308",
    "-1e308",
    "1e-308",
    "nan",
    "-inf",
    "true",
    '""',
    '"30 mm"',
    '"1e999 kn"',
    '"none"',
    '"main"',
    "[]",
    "[[1]]",
    "[1, 2]",
    "[1e-300, 1e-300, 1e-300]",
    "{}",
    '{ kind = "dynamic", duration = 1 }',
    '{ kind = ["x"] }',
    "[{}]",
    "1979-05-27T07:32:00Z",
    "9" * 500,
    '"\\u0000"',
]
few = settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.too_slow])


def judged(text):
    """Read a text: a case or problems in four non-empty parts that can be printed."""
    try:
        case = parse_case(text)
    except CaseError as error:
        assert error.problems
        assert all(p.where and p.found and p.allowed and p.cure for p in error.problems)
        assert "\x1b" not in str(error)
    else:
        assert isinstance(case, Case)
        assert all(0.0 < side < float("inf") for panel in case.gear for side in panel.size)


@few
@given(st.text())
def test_any_text(text):
    judged(text)


@few
@given(st.integers(0, len(EXAMPLE)), st.integers(0, 40), st.text(max_size=6))
def test_example_with_a_piece_replaced(start, length, piece):
    judged(EXAMPLE[:start] + piece + EXAMPLE[start + length :])


@few
@given(st.data())
def test_example_with_values_replaced(data):
    lines = EXAMPLE.splitlines()
    assigned = [i for i, line in enumerate(lines) if " = " in line]
    for i in data.draw(st.lists(st.sampled_from(assigned), min_size=1, max_size=4)):
        lines[i] = lines[i].split(" = ")[0] + " = " + data.draw(st.sampled_from(VALUES))
    judged("\n".join(lines))


@few
@given(st.lists(st.sampled_from(LINES), max_size=25))
def test_lines_of_a_case_in_any_order(lines):
    judged("schema = 1\n" + "\n".join(line.removeprefix("# ") for line in lines))


@few
@given(
    st.recursive(
        st.sampled_from(VALUES),
        lambda inner: (
            st.lists(inner, max_size=3).map(lambda vs: "[" + ", ".join(vs) + "]")
            | st.dictionaries(st.sampled_from(["kind", "law", "main", "x"]), inner, max_size=3).map(
                lambda d: "{ " + ", ".join(f"{k} = {v}" for k, v in d.items()) + " }"
            )
        ),
    ),
    st.sampled_from(
        ["water", "current", "twine", "netting", "gear", "drag", "solve", "compare", "output", "added_mass"]
    ),
)
def test_table_replaced_by_anything(value, table):
    judged(f"schema = 1\n{table} = {value}\n")
