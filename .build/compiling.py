"""How the kernels are compiled: found, translated in parallel, then compiled in parallel.

This is the build's backend: that of setuptools, with a `build_ext` (`[tool.setuptools.cmdclass]` in pyproject.toml) for
which every `penink_cli/**/_compiled/*.pyx` is an extension module. New kernels are found; nothing lists them. Cython
tracks what each includes and cimports. Flags of a single kernel stand in its first lines, as `# distutils:`.

The memoryview type, some 20 000 lines of C that Cython puts into every module that takes an array, stands once, in
`penink_cli._shared`. That halves the code to compile, and the code that a short-lived process loads.
"""

import os
import subprocess
from pathlib import Path

from Cython.Build import cythonize
from setuptools import Extension
from setuptools.build_meta import *  # noqa: F403  the hooks that pip and build call
from setuptools.command.build_ext import build_ext

SHARED = "penink_cli._shared"
# -ffp-contract=off, and no -march or -ffast-math, keep every byte of output the same on every machine.
# -fno-math-errno and -fno-trapping-math change no value: they let sqrt and selections vectorise.
FLAGS = ["-O3", "-g0", "-ffp-contract=off", "-fno-math-errno", "-fno-trapping-math"]
# Nothing that is declared as an array or a class may be None, unless its declaration says so.
DIRECTIVES = {"language_level": 3, "allow_none_for_extension_args": False}


def kernels() -> list[Extension]:
    """One extension module for each kernel of the tree, by name."""
    found = sorted(Path("penink_cli").glob("**/_compiled/*.pyx"))
    return [Extension(".".join(f.with_suffix("").parts), [f.as_posix()], extra_compile_args=FLAGS[:]) for f in found]


class BuildKernels(build_ext):
    """`build_ext` that finds the kernels and builds them in parallel."""

    def initialize_options(self) -> None:
        """Begin with no flag tried on the C compiler."""
        super().initialize_options()
        self._flags: dict[str, bool] = {}

    def finalize_options(self) -> None:
        """Find the kernels, and use every processor this process may run on, unless `--parallel` says otherwise."""
        listed = self.distribution.ext_modules
        names = {extension.name for extension in listed}
        listed += [kernel for kernel in kernels() if kernel.name not in names]
        super().finalize_options()
        if getattr(self, "parallel", None) is None:
            self.parallel = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()

    def build_extensions(self) -> None:
        """Translate all kernels, then compile them; kernels that are up to date are left as they are."""
        translated = cythonize(
            self.extensions,
            force=self.force,
            quiet=self.verbose == 0,
            nthreads=self.parallel if self.parallel > 1 else 0,
            compiler_directives=DIRECTIVES,
            shared_utility_qualified_name=SHARED,
        )
        for kernel, in_c in zip(self.extensions, translated, strict=True):
            kernel.sources, kernel.depends = in_c.sources, in_c.depends
            kernel.extra_compile_args = [flag for flag in in_c.extra_compile_args if self._known(flag)]
        super().build_extensions()

    def get_source_files(self) -> list[str]:
        """The files of the source distribution beside the package's modules: kernels, their headers, this file."""
        headers = [f.as_posix() for kind in ("pxd", "h") for f in Path("penink_cli").glob(f"**/_compiled/*.{kind}")]
        return [*super().get_source_files(), *sorted(headers), Path(__file__).relative_to(Path.cwd()).as_posix()]

    def _known(self, flag: str) -> bool:
        """Whether the C compiler takes the flag: clang refuses gcc's cost models, for one, and needs none."""
        if flag not in self._flags:
            empty = [*self.compiler.compiler, "-Werror", flag, "-fsyntax-only", "-x", "c", os.devnull]
            self._flags[flag] = subprocess.run(empty, capture_output=True, check=False).returncode == 0
        return self._flags[flag]
