"""The Taylor kernel: emitted C recurrences, compiled, that integrate many collisions in parallel lanes."""
