"""The equations as C headers of Taylor recurrences."""
