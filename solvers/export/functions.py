"""The functions of a scene's model as self-contained C, by CasADi's code generation."""

from casadi import CodeGenerator, Function

from ...generated.assemble import casadi_functions
from ..model.dimensionless import Problem, nondimensionalise
from ..model.model import Model, load, select_model
from ..scene.scene import Scene
from .equations import file_name
from .hybrid import units_of

_REGIONS = (("", 1, 1), ("_beyond_film", 0, 1), ("_beyond_shear", 1, 0), ("_beyond_both", 0, 0))


def texts(scene: Scene) -> dict[str, str]:
    """Texts of NAME.c and NAME.h: every function of the smallest full structure of the scene, in all regions."""
    oblique = scene.angle is None or scene.turns(scene.angle)
    model, name = load(select_model(scene, oblique, full=True)), file_name(scene)
    written = functions(model, name)
    generator = CodeGenerator(f"{name}.c", {"with_header": False, "casadi_int": "long long int"})
    for function in written:
        generator.add(function)
    values = None
    if scene.speed is not None and scene.angle is not None:
        values = nondimensionalise(scene, scene.speed, scene.angle)
    return {
        f"{name}.c": _comment(scene, model, values) + generator.dump(),
        f"{name}.h": _header(scene, name, model, written, values),
    }


def functions(model: Model, prefix: str) -> list[Function]:
    """The model's functions (state, groups, further scalars) -> column; one per region for those that depend on it."""
    result: dict[str, Function] = {}
    for suffix, film, shear in _REGIONS if model.oblique else _REGIONS[:2]:
        for name, function in casadi_functions(model.structure, model.laws, film, shear).items():
            regional = name in (*model.structure.REGIONAL, "jacobian", "event_rates")
            if not suffix or regional:
                full = f"{prefix}_{name}{suffix}"
                inputs = function.sx_in()
                result[full] = Function(full, inputs, [function(*inputs)], function.name_in(), [full])
    return list(result.values())


def _comment(scene: Scene, model: Model, values: Problem | None) -> str:
    """Comment at the head of the file that describes the functions."""
    units, choice, glassy = units_of(model), model.choice, scene.liquid.glass_transition_pressure is not None
    lines = [
        f"{scene.name or 'scene'}: functions of the structure `{choice.structure}`, emitted by wetdoublet.",
        "Laws: " + ", ".join(f"{slot} {law}" for slot, law in choice.laws if slot != "glass" or glassy) + ".",
        f"Equations sha256 {model.structure.DIGEST}",
        "",
        "Each function takes arg[0] = state, arg[1] = groups and fills res[0]; casadi's calling convention.",
        *(["T = obliquity; Omega = v0 T over the distance of the centres in contact."] if model.oblique else []),
        "Time in x0/v0. Suffix _beyond_film: gap > x0; _beyond_shear: beyond the edge of the tangential force.",
        "State: " + ", ".join(f"{name} [{units[name]}]" for name in model.state) + ".",
        "Groups: " + ", ".join(model.groups) + ".",
        *([] if values is None else [f"  {name} = {values.groups[name]!r}" for name in model.groups]),
        "Scene (SI): " + ", ".join(f"{name} = {value}" for name, value in scene.si),
    ]
    inside = "\n".join(f" * {line}".rstrip() for line in lines).replace("*/", "* /")
    return f"/*\n{inside}\n */\n"


def _header(scene: Scene, name: str, model: Model, written: list[Function], values: Problem | None) -> str:
    guard = f"WETDOUBLET_{name.upper()}_H"
    lines = [_comment(scene, model, values), f"#ifndef {guard}", f"#define {guard}", ""]
    lines += ["#ifdef __cplusplus", 'extern "C" {', "#endif", ""]
    lines += [
        f"#define {name.upper()}_STATES {len(model.state)}",
        f"#define {name.upper()}_GROUPS {len(model.groups)}",
        "",
    ]
    if values is not None:
        numbers_ = ", ".join(f"{values.groups[group]!r}" for group in model.groups)
        lines += [f"static const double {name}_groups[{len(model.groups)}] = {{{numbers_}}};", ""]
    for function in written:
        rows, columns = function.size_out(0)
        shape = f"{rows}" if columns == 1 else f"{rows} x {columns}, column by column"
        more = [f"arg[{k}] = {argument}" for k, argument in enumerate(function.name_in()) if k > 1]
        lines.append(f"/* {', '.join([f'{function.name()}: {shape}', *more])} */")
        lines.append(f"int {function.name()}(const double** arg, double** res, long long int* iw, double* w, int mem);")
        lines.append(
            f"int {function.name()}_work(long long int* sz_arg, long long int* sz_res, "
            "long long int* sz_iw, long long int* sz_w);"
        )
    lines += ["", "#ifdef __cplusplus", "}", "#endif", "", "#endif", ""]
    return "\n".join(lines)
