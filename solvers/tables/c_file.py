"""A table as one header in C99 (and C++): its data and a reader."""

import zlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from ...generated.automaton import CRITERIA, KINDS, OUTCOMES
from ..export.equations import file_name
from ..many.results import attributes
from .data import Law
from .labelled import where
from .maps import LEAST

_WIDTH = 110


def header(table: Law) -> str:
    """The text of the header; its reader refuses numbers that are not those of the checksum."""
    name = file_name(table.scene)
    reader = Path(__file__).with_name("reader.h").read_text(encoding="utf-8")
    real = "float" if table.data.results.coefficients.dtype == np.float32 else "double"
    big, arrays = _constants(name), _numbers(table)
    outcomes = ", ".join(f"{big}_{word.upper().replace('-', '_')} = {k}" for k, word in enumerate(OUTCOMES))
    criteria = ", ".join(f"{KINDS.index(word)} {word}" for word in CRITERIA)
    places = {
        "@NAME@": name, "@BIG@": big, "@REAL@": real, "@LEAST@": repr(LEAST), "@OUTCOMES@": outcomes,
        "@CRITERIA@": criteria,
        "@CHECKSUM@": f"0x{_checksum(arrays):08x}u",
        "@SUMS@": "\n".join(f"        {big}_SUM({name}_{key});" for key in arrays),
    }  # fmt: skip
    for word, text in places.items():
        reader = reader.replace(word, text)
    guard = f"{big}_H"
    parts = [
        _comment(table, name),
        f"#ifndef {guard}\n#define {guard}\n",
        _sizes(table, name),
        *(_array(kind.replace("real", real), f"{name}_{key}", values) for key, (kind, values) in arrays.items()),
        "",
    ]
    return "\n".join([*parts, reader, _functions(table, name), f"#endif /* {guard} */\n"])


def _constants(name: str) -> str:
    """The beginning of the names of constants, which are not those of the exported law of the scene."""
    return f"{name}_table".upper()


def _comment(table: Law, name: str) -> str:
    data, of, big = table.data, table.of, _constants(name)
    arguments = _arguments(table)
    ranges = [
        f"stokes    normal Stokes number, {table.range.stokes[0]!r} to {table.range.stokes[1]!r}",
        "          m v/(6 pi mu a^2): reduced mass m, normal approach speed v, viscosity mu, reduced radius a; SI",
        f"angle     impact angle in rad, {table.range.angle[0]!r} to {table.range.angle[1]!r}",
    ]
    if table.range.third is not None:
        unit = table.scene.fields[table.range.third].unit or "1"
        low, high = table.range.ends
        ranges.append(f"{arguments[2]}: {table.range.third} in {unit}, {low!r} to {high!r}")
    results = [
        f"value[{k}]  {one}: {attributes(one)['long_name']} ({attributes(one)['units']})" for k, one in enumerate(of)
    ]
    parameters = "".join(f"double {one}, " for one in arguments)
    example = ", ".join(("0.5 * (lo + hi)",) * len(arguments))
    lines = [
        f"Collision law of {table.scene.name or 'a scene'} as a table, made by wetdoublet.",
        "",
        f"    int {name}_table({parameters}{name}_answer *answer);",
        f"    int {name}_table_slopes({parameters}{name}_answer *answer, {name}_slopes *slopes);",
        "",
        f"Both return {big}_OK, or {big}_OUTSIDE where an argument is outside its range or NaN: nothing is",
        "extrapolated, the outcome is then -1 and all results are NaN. So they are where a number of this file is not",
        f"what was written ({big}_DAMAGED; tested at the first query). No allocation: safe from any thread.",
        "",
        "Arguments, all other entries as in the scene below:",
        *(f"    {one}" for one in ranges),
        "Results of collisions that separate (a stick has restitution 0 and NaN otherwise):",
        *(f"    {one}" for one in results),
        f"`slopes.by[m][k]` is the derivative of value[m] by argument k in the order above ({', '.join(arguments)}).",
        "",
        f"Error: at most {table.error:g} was asked for, over the magnitude of a result where that is above 1. Of",
        f"{table.found.queries} random and boundary-hugging queries, {table.found.direct} agreed with the collision at",
        "their own impact and the others with one at most 1e-6 (relative) beside it, across or along a boundary.",
        f"Largest error found: {table.found.largest:.3g}{where(table)}.",
        f"Data: {data.bytes} bytes, {data.maps.size} angle panels, {len(data.results.size)} patches.",
        "",
        "Example (range ends lo and hi):",
        f"    {name}_answer one;",
        f"    if ({name}_table({example}, &one) == {big}_OK && one.outcome != {big}_STICK)",
        "        v_after = one.value[0] * v_before;",
        "",
        "Scene:",
        *(f"    {line}" for line in table.scene.to_toml().replace("*/", "* /").splitlines()),
    ]
    return "\n".join(["/*", *(f" * {line}".rstrip() for line in lines), " */"])


def _arguments(table: Law) -> list[str]:
    third = table.range.third
    return ["stokes", "angle"] + ([] if third is None else [third.replace(".", "_")])


def _sizes(table: Law, name: str) -> str:
    data = table.data
    most = max(int(trees.size.max(initial=1)) for trees in (data.shapes, data.results))
    numbers = {
        "RESULTS": len(table.of), "VARIABLES": len(table.variables), "SLICES": data.slices.size - 1, "MOST": most,
    }  # fmt: skip
    lines = [f"#define {_constants(name)}_{key} {value}" for key, value in numbers.items()]
    return "\n".join([*lines, *_stokes_factor(table, name)]) + "\n"


def _stokes_factor(table: Law, name: str) -> list[str]:
    """The Stokes number per m/s; without the number where it depends on the third variable."""
    third = table.range.third
    scenes = [table.scene, *(table.scene.with_si({third: end}) for end in table.range.ends if third is not None)]
    factors = [scene.stokes_per_speed for scene in scenes]
    if not np.allclose(factors, factors[0], rtol=1e-12, atol=0.0):
        return [f"/* The Stokes number per m/s of normal speed depends on {third}: see the formula above. */"]
    return [f"#define {_constants(name)}_STOKES_PER_SPEED {factors[0]!r} /* s/m: times the normal approach speed */"]


def _numbers(table: Law) -> dict[str, tuple[str, np.ndarray]]:
    """The arrays of the header by name: their type in C ("real" is that of the coefficients), and their values."""
    data = table.data
    third = np.log(table.range.ends) if table.range.logarithmic else np.array(table.range.ends)
    arrays: dict[str, tuple[str, Any]] = {
        "range": ("double", [*table.range.stokes, *table.range.angle, *third.tolist()])
    }
    arrays["height"] = "double", [data.low[2], data.high[2]]
    for key, kind in (
        ("slices", "double"), ("first_panel", "int"), ("cuts", "int"), ("maps", "signed char"), ("first_edge", "int"),
        ("edges", "int"), ("outcome", "signed char"), ("criterion", "signed char"), ("cell_map", "signed char"),
        ("root", "int"),
    ):  # fmt: skip
        arrays[key] = kind, getattr(data, key)
    arrays["of_stick"] = "signed char", np.isnan(data.of_stick)
    for prefix, trees in (("shape_", data.shapes), ("", data.results)):
        for key, kind in (
            ("axis", "signed char"), ("cut", "double"), ("child", "int"), ("box", "double"), ("size", "short"),
            ("start", "int"),
        ):  # fmt: skip
            arrays[f"{prefix}{key}"] = kind, getattr(trees, key)
        arrays[f"{prefix}series"] = "double" if prefix else "real", trees.coefficients
    # an empty array has one element, as C knows none
    return {key: (kind, np.ravel(values) if np.size(values) else np.zeros(1)) for key, (kind, values) in arrays.items()}


def _checksum(arrays: Mapping[str, tuple[str, np.ndarray]]) -> int:
    """CRC-32 of all numbers, as doubles with the least significant byte first."""
    return zlib.crc32(b"".join(values.astype("<f8").tobytes() for _, values in arrays.values()))


def _array(kind: str, name: str, values: np.ndarray) -> str:
    """A constant array."""
    if kind == "float":
        words = [f"{np.format_float_scientific(value, unique=True, trim='0', exp_digits=1)}f" for value in values]
    elif kind == "double":
        words = [repr(float(value)) for value in values]
    else:
        words = [str(int(value)) for value in values]
    lines, line = [], "   "
    for word in words:
        if len(line) + len(word) > _WIDTH:
            lines.append(line)
            line = "   "
        line += f" {word},"
    return "\n".join([f"static const {kind} {name}[{len(words)}] = {{", *lines, line.rstrip(","), "};"])


def _functions(table: Law, name: str) -> str:
    arguments = _arguments(table)
    parameters = ", ".join(f"double {one}" for one in arguments)
    third = "0.5" if len(arguments) < 3 else arguments[2]
    taken = f"{third} > 0.0 ? log({third}) : -1e300" if table.range.logarithmic else third
    scaled = ""
    if table.range.logarithmic:
        scaled = f"    for (m = 0; m < {_constants(name)}_RESULTS; ++m)\n        slopes->by[m][2] /= {third};\n"
    return f"""/* Outcome and results at an impact. */
static inline int {name}_table({parameters}, {name}_answer *answer)
{{
    return {name}_read({taken}, angle, stokes, answer, 0);
}}

/* The same with derivatives. */
static inline int {name}_table_slopes({parameters}, {name}_answer *answer, {name}_slopes *slopes)
{{
{"    int m;" + chr(10) if scaled else ""}    int status = {name}_read({taken}, angle, stokes, answer, slopes);
{scaled}    return status;
}}
"""
