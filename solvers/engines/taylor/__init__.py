"""The Taylor kernel: emitted C recurrences, compiled on first use, that collide many doublets side by side."""
