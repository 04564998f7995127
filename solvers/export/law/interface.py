"""The law's structures and functions as its header declares them, for Fortran (iso_c_binding) and ctypes."""

import re

_KINDS = {"int": "integer(c_int)", "long": "integer(c_long)", "double": "real(c_double)"}
_MESSAGE = """\
  ! A status in words.
  function law_message(status) result(text)
    integer(c_int), intent(in) :: status
    character(:), allocatable :: text
    character(kind=c_char), pointer :: letters(:)
    type(c_ptr) :: found
    integer :: k
    interface
      function message(status) bind(c, name="law_message") result(found)
        import
        integer(c_int), value :: status
        type(c_ptr) :: found
      end function message
      function length_of(text) bind(c, name="strlen") result(length)
        import
        type(c_ptr), value :: text
        integer(c_size_t) :: length
      end function length_of
    end interface
    found = message(status)
    call c_f_pointer(found, letters, [length_of(found)])
    allocate (character(size(letters)) :: text)
    do k = 1, size(letters)
      text(k:k) = letters(k)
    end do
  end function law_message
"""
Fields = list[tuple[str, str, tuple[int, ...]]]
"""Members of a structure: type, name, shape."""


def structures(header: str) -> dict[str, Fields]:
    """The structures that a host fills or reads, by name."""
    bodies = re.findall(r"typedef struct \{([^}]*)\} (law_\w+);", header)
    return {
        name: [
            (kind, member, tuple(map(int, re.findall(r"\d+", shape))))
            for kind, member, shape in re.findall(r"^ *(int|double|law_\w+) (\w+)((?:\[\d+\])*);", body, re.MULTILINE)
        ]
        for body, name in bodies
    }


def ctypes_fields(fields: Fields) -> str:
    """The members as fields of a ctypes structure."""
    kinds = ("".join([f"ctypes.c_{kind}", *(f" * {n}" for n in reversed(shape))]) for kind, _, shape in fields)
    return ", ".join(f'("{name}", {kind})' for kind, (_, name, _) in zip(kinds, fields, strict=True))


def fortran(header: str) -> str:
    """NAME.f90 with `law_` in the place of the law's prefix; arrays have the component first."""
    lines = ["! The law from Fortran; what everything means stands in the header of the C file.", "module @NAME@"]
    lines += ["  use, intrinsic :: iso_c_binding", "  implicit none", ""]
    constants = re.findall(r"^(?:#define|   ) (LAW_[A-Z]\w*) =? ?(-?\d+)\b", header, re.MULTILINE)
    lines += [*(f"  integer(c_int), parameter :: {name} = {value}" for name, value in constants), ""]
    for name, fields in structures(header).items():
        lines.append(f"  type, bind(c) :: {name}")
        for kind, member, shape in fields:
            declared = _KINDS.get(kind, f"type({kind})")
            lines.append(f"    {declared} :: {member}" + (f"({', '.join(map(str, shape[::-1]))})" if shape else ""))
        lines += [f"  end type {name}", ""]
    functions = re.findall(r"^(\w+) (law_\w+)\(\s*([^;]*?)\);", header, re.MULTILINE)
    blocks = "\n\n".join(_function(*each) for each in functions)
    lines += ["  interface", *blocks.splitlines(), "  end interface", "", "contains", "", *_MESSAGE.splitlines()]
    return "\n".join([*lines, "end module @NAME@", ""])


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
        changed = type_name in ("law_particle", "law_pair_history") or name == "law_advance"
        intent = "in" if type_ != type_name else "inout" if changed else "out"
        array = "(count)" if counted and type_name != "law_material" else ""
        declared.append((type_name, f"type({type_name}), intent({intent})", f"{bare}{array}"))
    declared.sort(key=lambda each: each[2] != "count" and not each[1].startswith("type(law_material)"))
    names = ", ".join(each.lstrip("*") for _, each in arguments)
    head = f"    function {name}({f' &{chr(10)}        ' if names else ''}{names}) bind(c)"
    returned = f"type({kind})" if kind.startswith("law_") else _KINDS[kind]
    lines = [head + ("" if result == name else f" result({result})"), "      import"]
    lines += [f"      {type_} :: {member}" for _, type_, member in declared]
    return "\n".join([*lines, f"      {returned} :: {result}", f"    end function {name}"])
