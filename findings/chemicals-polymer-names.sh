#!/usr/bin/env bash
# chemicals 1.5.2: names of polymers
#
# Guess: `CAS_from_any`, which finds a chemical by any of its names, does not know the name of a polymer, or answers
#   with the polymer.
# What happens: it answers with a small molecule: polyethylene glycol is ethylene glycol, PEG 400 the pentamer of 238
#   g/mol, PVP and polyvinylpyrrolidone the monomer, PDMS and dimethicone the trimer, xanthan gum is xanthene, a solid
#   of three rings. "silicone oil" and "PEG 600" are refused, as one would expect. No message.
# Why: the names are those that PubChem lists for a molecule, in which depositors have put the polymers made of it.
# Why it matters here: these are the liquids that wet grains are bound with. Ethylene glycol at 20 degC has 0.02 Pa s, a
#   polyethylene glycol of 400 g/mol five times that, an aqueous solution of PVP anything up to 10 Pa s. Look at the
#   molar mass of what was found.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check \
  'chemicals==1.5.2' 'fluids==1.3.1' 'numpy==2.4.6' 'scipy==1.17.1' 'pandas==3.1.1'
cd "$work"
"$work/venv/bin/python" -W ignore - <<'PY'
import chemicals

SMALL = {
    "polyethylene glycol": "107-21-1", "PEG 400": "4792-15-8", "PVP": "88-12-0", "polyvinylpyrrolidone": "88-12-0",
    "PDMS": "107-51-7", "dimethicone": "107-51-7", "xanthan gum": "92-83-1",
}
print("chemicals", chemicals.__version__)
for name, number in SMALL.items():
    found = chemicals.search_chemical(name)
    print(f"{name:22s} {found.CASs:10s} {found.common_name:24s} {found.MW:6.1f} g/mol; right: a polymer, or an error")
    assert found.CASs == number, f"changed: {name}"
for name in ("silicone oil", "PEG 600"):
    try:
        chemicals.search_chemical(name)
    except ValueError as error:
        print(f"{name:22s} {error}")
    else:
        raise AssertionError(f"changed: {name}")
PY
