"""Puts the shared library and the program, which ./setup.sh has built, the header of its functions and the tissues of
validation into the package."""
import shutil
from pathlib import Path

from setuptools import Distribution, setup
from setuptools.command.build_py import build_py

ROOT = Path(__file__).resolve().parents[1]
FILES = ["build/liblamella.so", "build/lamella", "include/lamella/bind.h"]


class Build(build_py):
    def run(self):
        super().run()
        for file in FILES:
            if not (ROOT / file).is_file():
                raise SystemExit(f"{ROOT / file} is missing: build Lamella first, by ./setup.sh")
            shutil.copy2(ROOT / file, Path(self.build_lib) / "lamella")
        shutil.copytree(ROOT / "tests" / "scenes" / "tissues", Path(self.build_lib) / "lamella/validation/scenes/tissues",
                        dirs_exist_ok=True)


class WithLibrary(Distribution):
    """Of one platform."""

    def has_ext_modules(self):
        return True


setup(cmdclass={"build_py": Build}, distclass=WithLibrary)
