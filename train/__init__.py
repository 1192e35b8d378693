"""Training and evaluation with Stable-Baselines3. Needs the extra `train`."""

if not __name__.startswith("tensegym."):
    raise ImportError("import tensegym.train, not train: the folder is a part of the tensegym package")
