"""``python -m tensegym``: the console command."""

from tensegym.cli.main import main

if __name__ == "__main__":
    main()
