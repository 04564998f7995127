#!/usr/bin/env bash
# csv-edem 1.7.6: more than 32767 collisions
#
# Guess: the mean, the least and the largest number of collisions that it reports of an EDEM export are those of the
#   file.
# What happens: up to 32767 they are. Beyond it they are other numbers: 30000, 32000, ... 40000 collisions have a mean
#   of -8691 in place of 35000, their maximum is 32000 and their minimum -31536. The times and forces beside them are
#   right, and so is the number of rows. The only message is NumPy's on a logarithm of a further mean.
# Why: the numbers are stored in 16 bits with a sign, and the conversion from the file's floating-point numbers is not
#   checked.
# Why it matters here: the frequency of collisions and the share of them that sticks make up the growth of granules, and
#   some ten thousand spheres have as many collisions within one interval of an export. If only some rows lie beyond the
#   bound, the mean is too small without being negative: 18077 for 29000.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
# its list of requirements has what its window and its command line need as well
"$work/venv/bin/pip" install -qq --disable-pip-version-check --no-deps 'csv-edem==1.7.6' 'et-xmlfile==2.0.0' \
    'numpy==2.4.6' 'openpyxl==3.1.5'
cd "$work"
"$work/venv/bin/python" -W ignore - <<'PY'
from importlib.metadata import version

import numpy as np
from csv_edem.csv_edem_controller import CSV_Edem_Controller
from csv_edem.csv_input import CSV_Edem_input

HEADER = 25  # lines above the numbers, the default of its command line


def report(counts):
    """Least, largest and mean number of collisions that it reports of an export with these."""
    with open("export.csv", "w") as file:
        print("\n" * (HEADER - 1), file=file)
        for row, count in enumerate(counts):
            print(f"{1.1 + row / 10:.1f},{count},{0.01 * (row + 1):.2f}", file=file)
    export = CSV_Edem_input("export.csv", lines_to_skip=HEADER)
    export.extractRawData()
    export.getDataFromTime(1.01)
    found = CSV_Edem_Controller(export)
    found.saveSummary("summary")
    with open("summary.txt") as file:
        lines = dict(line.strip().split(": ") for line in file if "collision:" in line)
    assert len(export.time) == len(counts) and np.isclose(found.getMeanForce(), 0.035), "times and forces"
    return [float(lines[f"{name} collision"]) for name in ("Minimum", "Maximum", "Mean")]


print("csv-edem", version("csv-edem"))
print("collisions in the file       least    largest       mean   right mean")
means = []
for start in (20_000, 22_767, 24_000, 30_000, 40_000):
    counts = [start + 2000 * step for step in range(6)]
    least, largest, mean = report(counts)
    means.append((mean, np.mean(counts)))
    print(f"{counts[0]} to {counts[-1]:14d} {least:12.0f} {largest:10.0f} {mean:10.1f} {np.mean(counts):12.1f}")
for mean, right in means[:2]:
    assert mean == right, "up to 32767"
for mean, right in means[2:]:
    assert mean < 0.9 * right, "changed: beyond 32767"
PY
