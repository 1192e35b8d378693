"""Fitted models of a hinge: the paper's springs and the potential."""
