"""Controllers: one-step tipping, the open-loop walker."""
