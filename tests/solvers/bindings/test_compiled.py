"""numba and cffi call the exported law; the estimator keeps scikit-learn's protocol; extras are asked for by name."""

import subprocess
import sys

import numpy as np
import pytest
from wetdoublet.estimator import CollisionRegressor
from wetdoublet.solvers import InputError, collide_many
from wetdoublet.solvers.bindings.extras import required

SPEED, ANGLE = np.array([1.0, 2.6, 3.0]), np.array([0.2, 0.0, 1.0])


def test_numba_compiles_loops_over_the_law() -> None:
    """In nopython mode; the numbers are those of `collide_many`."""
    numba = pytest.importorskip("numba", reason="numba is not installed: pip install -e '.[numba]'")
    from wetdoublet.solvers.bindings.numba import law

    granulation = law("granulation")
    collide = granulation.collide_many

    @numba.njit
    def mean(material: np.ndarray, impacts: np.ndarray, found: np.ndarray) -> float:
        failed = collide(material, impacts, 1e-9, found)
        return found["restitution"].mean() + failed

    expected = collide_many("granulation", speed=SPEED, angle=ANGLE)
    impacts, found = np.zeros(3, granulation.impact), np.zeros(3, granulation.collision)
    impacts["speed"], impacts["angle"] = SPEED, ANGLE
    assert mean(granulation.material, impacts, found) == pytest.approx(expected.restitution.values.mean(), rel=1e-7)
    assert np.array_equal(found["outcome"], expected.outcome.values)
    thinner = granulation.material.copy()
    thinner["viscosity"] /= 2
    collide(thinner, impacts, 1e-9, found)
    changed = collide_many("granulation", speed=SPEED, angle=ANGLE, vary={"liquid.viscosity": 1.0})
    assert np.allclose(found["restitution"], changed.restitution.values, rtol=1e-7)
    assert granulation.address > 0
    with pytest.raises(ValueError, match="as many"):
        collide(thinner, impacts, 1e-9, found[:2])


def test_cffi_has_the_headers_functions() -> None:
    """Structures, functions and enumerators."""
    pytest.importorskip("cffi", reason="cffi is not installed: pip install -e '.[cffi]'")
    from wetdoublet.solvers.bindings.cffi import law

    ffi, lib = law("pendulum")
    material, found = ffi.new("law_material *", lib.law_default_material()), ffi.new("law_collision *")
    assert lib.law_collide(material, ffi.new("law_impact *", (1.0, 0.5)), 1e-9, 0, found) == lib.LAW_OK
    expected = collide_many("pendulum", speed=1.0, angle=0.5)
    assert found.outcome == expected.outcome.item()
    assert found.restitution == pytest.approx(expected.restitution.item(), rel=1e-7)


def test_the_estimator_finds_what_made_its_data() -> None:
    """And predicts it, refuses other shapes, and lists its parameters."""
    X = np.array([[2.2, 0.0], [2.3, 0.1], [2.5, 0.2], [1.0, 0.0]])
    truth = CollisionRegressor("granulation", "liquid.viscosity", starts=1)
    y = truth.predict(X)
    found = CollisionRegressor(truth.scene, ["liquid.viscosity"], starts=1).fit(X, y)
    estimate = found.fit_.estimates["liquid.viscosity"]
    assert estimate.low < 2.0 < estimate.high
    assert found.score(X, y) > 0.99
    assert found.get_params()["starts"] == 1
    assert found.set_params(starts=2).starts == 2
    with pytest.raises(InputError, match="X"):
        found.predict(X[:, :1])
    with pytest.raises(ValueError, match="no argument"):
        found.set_params(start=2)


def test_scikit_learn_takes_the_estimator() -> None:
    """Clones, cross-validation, and those of its checks that do not draw impacts that cannot be (negative speeds)."""
    pytest.importorskip("sklearn", reason="scikit-learn is not installed")
    from sklearn.base import clone, is_regressor
    from sklearn.model_selection import cross_val_score
    from sklearn.utils import estimator_checks as checks

    one = CollisionRegressor(starts=1)
    assert is_regressor(one) and clone(one).get_params() == one.get_params()
    X = np.array([[2.2, 0.0], [2.3, 0.1], [2.5, 0.2], [1.0, 0.0], [2.4, 0.1], [2.8, 0.2]])
    assert (cross_val_score(one, X, one.predict(X), cv=2) > 0.9).all()
    for check in (
        checks.check_no_attributes_set_in_init, checks.check_parameters_default_constructible,
        checks.check_get_params_invariance, checks.check_set_params, checks.check_estimator_cloneable,
        checks.check_estimator_repr, checks.check_valid_tag_types,
    ):  # fmt: skip
        check("CollisionRegressor", one)


_EXPECTED = {  # reason -> checks of scikit-learn that fail for it
    "draws another number of columns than speed and angle": """
        check_fit_score_takes_y check_dont_overwrite_parameters check_n_features_in_after_fitting
        check_estimators_dtypes check_dtype_object check_pipeline_consistency check_estimators_pickle
        check_f_contiguous_array_estimator check_regressors_train check_regressor_data_not_an_array
        check_regressors_no_decision_function check_supervised_y_2d check_regressors_int
        check_methods_sample_order_invariance check_methods_subset_invariance check_dict_unchanged
        check_fit2d_predict1d""",
    "draws speeds below 0 or angles beyond 90 deg": """
        check_estimators_overwrite_params check_estimators_fit_returns_self check_readonly_memmap_input
        check_positive_only_tag_during_fit check_fit_idempotent check_fit_check_is_fitted check_n_features_in""",
    "wants its own words in a message; ours name the column and what is accepted": """
        check_estimators_empty_data_messages check_estimators_nan_inf check_fit2d_1sample check_fit2d_1feature
        check_requires_y_none""",
    "predict before fit answers with the scene as it is given": "check_estimators_unfitted",
}


@pytest.mark.filterwarnings("ignore:.*BaseEstimator")  # its protocol is implemented without its base class
def test_scikit_learn_checks_all_but_those_that_cannot_be() -> None:
    """All of `check_estimator` passes, except the checks whose data are no impacts, or that want their own words."""
    checks = pytest.importorskip("sklearn.utils.estimator_checks", reason="scikit-learn is not installed")
    found = checks.check_estimator(
        CollisionRegressor(starts=1),
        expected_failed_checks={name: reason for reason, names in _EXPECTED.items() for name in names.split()},
        on_skip=None,
        on_fail=None,
    )
    assert [one["check_name"] for one in found if one["status"] == "failed"] == []


def test_a_missing_extra_is_named_with_its_commands() -> None:
    """Both that of an installation and that of a clone."""
    with pytest.raises(ImportError, match=r"pip install 'wetdoublet\[jax\]'.*pip install -e '\.\[jax\]'"):
        required("a_module_that_nobody_has", "jax")


def test_the_package_imports_none_of_them() -> None:
    """Nor does a collision."""
    code = (
        "import sys, wetdoublet as wd; wd.collide_many('granulation', stokes=0.02, angle=1.0); "
        "assert not {'jax', 'torch', 'numba', 'cffi', 'sklearn'} & set(sys.modules)"
    )
    subprocess.run([sys.executable, "-c", code], check=True)
