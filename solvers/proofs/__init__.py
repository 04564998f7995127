"""Outcomes that are proved, for stored numbers or for whole boxes of them: one collision, a map, a boundary."""
