"""The law's structures and functions as its header declares them, for Fortran (iso_c_binding) and ctypes."""

import re

_KINDS = {"int": "integer(c_int)", "long": "integer(c_long)", "double": "real(c_double)"}
Fields = list[tuple[str, str, tuple[int, ...]]]
"""Members of a structure: type, name, shape."""


def structures(header: str) -> dict[str, Fields]:
    """The structures that a host fills or reads; what a contact keeps between calls is only for C."""
    bodies = re.findall(r"typedef struct \{([^}]*)\} (law_\w+);", header)
    return {
        name: [
            (kind, member, tuple(map(int, re.findall(r"\d+", shape))))
            for kind, member, shape in re.findall(r"^ *(int|double) (\w+)((?:\[\d+\])*);", body, re.MULTILINE)
        ]
        for body, name in bodies
        if name != "law_contact"
    }


def ctypes_fields(fields: Fields) -> str:
    """The members as fields of a ctypes structure."""
    kinds = ("".join([f"ctypes.c_{kind}", *(f" * {n}" for n in reversed(shape))]) for kind, _, shape in fields)
    return ", ".join(f'("{name}", {kind})' for kind, (_, name, _) in zip(kinds, fields, strict=True))


def fortran(header: str) -> str:
    """NAME.f90 with `law_` in the place of the law's prefix; arrays have the component first."""
    lines = ["! The law from Fortran; what everything means stands in the header of the C file.", "module @NAME@"]
    lines += ["  use, intrinsic :: iso_c_binding", "  implicit none", ""]
    for name, fields in structures(header).items():
        lines.append(f"  type, bind(c) :: {name}")
        for kind, member, shape in fields:
            lines.append(f"    {_KINDS[kind]} :: {member}" + (f"({', '.join(map(str, shape[::-1]))})" if shape else ""))
        lines += [f"  end type {name}", ""]
    functions = re.findall(r"^(\w+) (law_\w+)\(\s*([^;]*?)\);", header, re.MULTILINE)
    blocks = [_function(*each) for each in functions if "law_contact *" not in each[2]]
    lines += ["  interface", *"\n\n".join(blocks).splitlines(), "  end interface", "end module @NAME@", ""]
    return "\n".join(lines)


def _function(kind: str, name: str, parameters: str) -> str:
    """The interface of a C function; what it only reads is `const`, and with a `count` pointers are arrays."""
    arguments = [] if parameters == "void" else [each.strip().rsplit(" ", 1) for each in parameters.split(",")]
    counted = any(each == "count" for _, each in arguments)
    result = {"int": "status", "long": "failed"}.get(kind, name)
    declared = []
    for type_, each in arguments:
        type_name, bare = type_.removeprefix("const "), each.lstrip("*")
        if not each.startswith("*"):
            declared.append((type_name, f"{_KINDS[type_name]}, value", bare))
            continue
        intent = "in" if type_ != type_name else "inout" if type_name == "law_particle" else "out"
        array = "(count)" if counted and type_name != "law_material" else ""
        declared.append((type_name, f"type({type_name}), intent({intent})", f"{bare}{array}"))
    declared.sort(key=lambda each: each[2] != "count" and not each[1].startswith("type(law_material)"))
    types = [kind, *(type_name for type_name, *_ in declared)]
    imported = [f"c_{each}" for each in ("int", "long", "double") if each in types]
    imported += dict.fromkeys(each for each in types if each.startswith("law_"))
    head = f"    function {name}({', '.join(each.lstrip('*') for _, each in arguments)}) bind(c)"
    returned = f"type({kind})" if kind.startswith("law_") else _KINDS[kind]
    lines = [head + ("" if result == name else f" result({result})"), f"      import :: {', '.join(imported)}"]
    lines += [f"      {type_} :: {member}" for _, type_, member in declared]
    return "\n".join([*lines, f"      {returned} :: {result}", f"    end function {name}"])
