#!/usr/bin/env bash
# thermo 0.6.1: viscosities of oils without data
#
# Guess: for a liquid of which thermo has no viscosity it gives none, or an estimate of the right order.
# What happens: oleic acid at 20 degC has 0.96 mPa s, 39 is measured (40 times as much); dioctyl phthalate 0.98 (81 are
#   measured), squalane 0.69 (36). The limits that go with it are 195 to 781 K, so that 20 degC counts as inside.
# Why: the one method left, Letsou and Stiel's, is one of corresponding states, made for reduced temperatures from 0.76
#   to 0.98, which is 320 to 490 degC here. Its lower limit in thermo is a quarter of the critical temperature.
# Why it matters here: such oils are what impacts of wetted spheres are measured with. Forty times too thin, a film of
#   oil has forty times the Stokes number: everything bounces. Ask for `ViscosityLiquid.method`, and take no LETSOU_STIEL
#   or PRZEDZIECKI_SRIDHAR below three quarters of the critical temperature.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -qq --disable-pip-version-check 'thermo==0.6.1' 'chemicals==1.5.2' 'fluids==1.3.1' \
  'numpy==2.4.6' 'scipy==1.17.1' 'pandas==3.1.1'
cd "$work"
"$work/venv/bin/python" -W ignore - <<'PY'
import thermo
from thermo import Chemical

KELVIN = 293.15
MEASURED = {"oleic acid": 39e-3, "dioctyl phthalate": 81e-3, "squalane": 36e-3}  # Pa s, of handbooks, to 10 %
print("thermo", thermo.__version__, "- 20 degC")
for name, right in MEASURED.items():
    liquid = Chemical(name, T=KELVIN, P=101325.0)
    model = liquid.ViscosityLiquid
    low, high = model.T_limits[model.method]
    print(
        f"{name:18s} {liquid.mu * 1e3:5.2f} mPa s by {model.method}, {low:.0f} to {high:.0f} K; measured"
        f" {right * 1e3:.0f}; reduced temperature {KELVIN / liquid.Tc:.2f}"
    )
    assert model.method == "LETSOU_STIEL" and low < KELVIN < high, "changed: method"
    assert liquid.mu < right / 30, "changed: viscosity"
water = Chemical("water", T=KELVIN, P=101325.0).mu
assert abs(water / 1.0016e-3 - 1) < 1e-3, "the comparison"
PY
