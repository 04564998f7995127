"""What properties of collisions are tested with: structures that cover each other's choices, random scenes, references."""
