"""Design search: a motion as a task, a space of designs and controllers, a sampler, and the workers that evaluate."""
