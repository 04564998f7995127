"""The Taylor kernel: emitted C recurrences, compiled with the package or on first use, that integrate many collisions in parallel lanes."""
