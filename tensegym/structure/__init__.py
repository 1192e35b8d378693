"""What a tensegrity is, at rest: nodes and members, equilibrium, form finding, faces, symmetry, modes."""
