"""The Taylor kernel: emitted C recurrences, compiled on first use, that integrate many collisions in parallel lanes."""
