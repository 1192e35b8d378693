.PHONY: test lint
test:
	.venv/bin/python -m pytest
lint:
	.venv/bin/ruff check .
	.venv/bin/mypy
