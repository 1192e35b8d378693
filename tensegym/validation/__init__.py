"""The physics against closed forms."""
