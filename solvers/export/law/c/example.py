"""The law by ctypes: `make shared`, then `python3 example.py`."""

import ctypes
import pathlib


class Material(ctypes.Structure):
    """Of the header; SI."""

    _fields_ = [@MATERIAL@]


class Impact(ctypes.Structure):
    """m/s, rad, rad/s."""

    _fields_ = [@IMPACT@]


class Collision(ctypes.Structure):
    """Integers, then numbers in SI; NaN where a number is not defined."""

    _fields_ = [@INTEGERS@] + [@DOUBLES@]


law = ctypes.CDLL(str(pathlib.Path(__file__).parent / "lib@NAME@.so"))
law.law_default_material.restype = Material
law.law_message.restype = ctypes.c_char_p
law.law_collide.argtypes = [ctypes.POINTER(Material), ctypes.POINTER(Impact), ctypes.c_double, ctypes.POINTER(Collision)]

if __name__ == "__main__":
    material = law.law_default_material()
    print("speed (m/s)  outcome  restitution")
    for k in range(9):
        impact = Impact(speed=@SPEED@ * 10 ** (k / 4 - 1), angle=1.0)
        found = Collision()
        status = law.law_collide(material, impact, 1e-9, found)
        print(f"{impact.speed:11.4g}  {found.outcome:7d}  {found.restitution:.9f}", law.law_message(status).decode())
