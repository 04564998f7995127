"""Faults of the package, each with the property that must notice it."""

from typing import NamedTuple

RUNTIME = "solvers/engines/taylor/runtime"


class Mutant(NamedTuple):
    """A text of a file of the package, what stands in its place, and the property, as MODULE::FUNCTION."""

    file: str
    old: str
    new: str
    property: str


MUTANTS = {
    "a loss booked twice in a million times": Mutant(
        f"{RUNTIME}/ledger.h", "book->dry += in_lane(", "book->dry += 1.0000003*in_lane(",
        "test_conservation.py::test_the_ledger_closes",
    ),
    "an arm beside mid-gap": Mutant(
        "generated/taylor/laws/arm_midgap.h", "s->result[k] = 0.5*", "s->result[k] = 0.5001*",
        "test_conservation.py::test_angular_momentum_is_kept",
    ),
    "a clock that depends on the lane": Mutant(
        f"{RUNTIME}/queue.h", "LANE(l->time, lane) = 0.0;\n", "LANE(l->time, lane) = 1e-12*lane;\n",
        "test_engines.py::test_neighbours_and_order_change_no_bit",
    ),
    "a tolerance ten thousand times too loose": Mutant(
        f"{RUNTIME}/tolerance.h", "double rtol = PER_STEP*q->rtol;", "double rtol = 1e4*q->rtol;",
        "test_engines.py::test_rtol_is_the_error",
    ),
    "a film that the kernel alone has": Mutant(
        "generated/taylor/laws/film_finite.h", "(-2.0)", "(-2.001)", "test_engines.py::test_a_replay_is_the_kernel",
    ),
    "a batch with restitutions of its own": Mutant(
        "solvers/many/by_kernel.py", 'np.where(separated, answers["shown"][:, 0], 0.0)',
        'np.where(separated, answers["shown"][:, 0]*(1 + 1e-5), 0.0)',
        "test_engines.py::test_a_batch_is_its_collisions",
    ),
    "a saltation that is too small": Mutant(
        f"{RUNTIME}/tangent_step.h", "-value/choose(falls", "-0.999*value/choose(falls",
        "test_derivatives.py::test_a_derivative_is_the_extrapolated_difference",
    ),
    "a certificate that always holds": Mutant(
        f"{RUNTIME}/certificates.h", "    mask proved = splat_mask(0);\n    (void)c; (void)y; (void)b; (void)contact;",
        "    mask proved = splat_mask(TRUTH);\n    (void)c; (void)y; (void)b; (void)contact;",
        "test_sticks_and_boundaries.py::test_a_certified_stick_followed_on_never_separates",
    ),
    "a length that is none": Mutant(
        "generated/taylor/shared/scale_oblique_bridge.h", "vec_exp(0.6*vec_log(q[SI_REDUCED_RADIUS]))",
        "vec_exp(0.61*vec_log(q[SI_REDUCED_RADIUS]))", "test_symmetries.py::test_similarity",
    ),
    "another film than the documents'": Mutant(
        "generated/taylor/laws/film_finite.h", "(-2.0)", "(-2.001)", "test_reference.py::test_equals_the_reference",
    ),
    "an approach in the plane that is too fast": Mutant(
        "solvers/collision/space/by_kernel.py", "impacts = KernelImpacts(scene, -pairs.opening,",
        "impacts = KernelImpacts(scene, -1.0001*pairs.opening,",
        "test_reference.py::test_a_plane_turned_in_space_is_the_plane",
    ),
    "an approach in space that is too fast": Mutant(
        "solvers/collision/space/pairs.py",
        "Impacts(self.scene, -self.opening,", "Impacts(self.scene, -1.0001*self.opening,",
        "test_reference.py::test_equals_the_reference_in_space",
    ),
    "no range": Mutant(
        "solvers/scene/fields.py", "if self.range.holds(value):", "if self.range is not None:",
        "../solvers/scene/test_refused.py::test_a_spoilt_entry_is_named",
    ),
    "the farthest name": Mutant(
        "solvers/errors.py", 'return f", did you mean {name}?" if name else ""',
        'return f", did you mean {name[::-1]}?" if name else ""',
        "../solvers/scene/test_refused.py::test_a_misspelt_entry_is_told_the_nearest",
    ),
    "a restitution that is too large": Mutant(
        "solvers/collision/assemble.py", '"contact_time": time, "until": time}',
        '"contact_time": time, "until": time, "restitution": 1.3*results.get("restitution", 0.0)}',
        "test_conservation.py::test_restitution_stays_below_its_ceiling",
    ),
    "a partner that is too large": Mutant(
        "solvers/scene/quantities.py", '{"radius_ratio": radius_ratio, "mass_ratio": mass_ratio}',
        '{"radius_ratio": 1.01 * radius_ratio, "mass_ratio": mass_ratio}',
        "test_symmetries.py::test_a_partner_equal_to_the_sphere_is_the_sphere",
    ),
    "a heavier wall": Mutant(
        "solvers/scene/quantities.py", 'result["reduced_mass"] * over_equal(mass_ratio)',
        'result["reduced_mass"] * over_equal(mass_ratio) * (1.01 if ways.wall else 1.0)',
        "test_symmetries.py::test_a_wall_is_a_huge_partner",
    ),
    "spins with a sense": Mutant(
        "solvers/scene/quantities.py", 'result.setdefault("impact_spin", 0.0)\n',
        'result["impact_spin"] = (spin := result.get("impact_spin", 0.0)) + 0.01*abs(spin)\n',
        "test_symmetries.py::test_a_reflection_changes_nothing",
    ),
    "a change that is not reported": Mutant(
        "solvers/boundaries/trace.py", "changes[k] = tuple(outcome_changes)",
        "changes[k] = tuple(outcome_changes[1:])",
        "test_sticks_and_boundaries.py::test_nothing_changes_between_boundaries",
    ),
    "strings that pull too much": Mutant(
        "generated/taylor/laws/strings_exact.h", "c->combination_offset = (c->string_ratio*c->string_ratio);",
        "c->combination_offset = 0.9*(c->string_ratio*c->string_ratio);",
        "test_reference.py::test_equals_the_reference",
    ),
    "a film that proofs alone have": Mutant(
        "generated/interval/laws/film_finite.h", "c->k1 = d_ratio(-2.0, 1.0);", "c->k1 = d_ratio(-2.01, 1.0);",
        "test_sticks_and_boundaries.py::test_a_proof_holds_the_collision",
    ),
}  # fmt: skip
