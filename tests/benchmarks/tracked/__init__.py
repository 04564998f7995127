"""What asv follows from commit to commit: CPU times over those of a reference of the same run, and errors beside."""
