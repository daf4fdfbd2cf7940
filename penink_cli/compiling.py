"""How the kernels are compiled: translated one after another, then by as many C compilers as there are processors.

Only the build uses this (`[tool.setuptools.cmdclass]` in pyproject.toml), and it loads this file by itself, before
the package can be imported. Cython's translator keeps global state, so setuptools' own parallel build, which would
translate in its threads too, is not safe; the C compilers, most of the work, are processes of their own.

What Cython puts into every module that takes an array (the memoryview type, some 20 000 lines of C) stands once, in
`penink_cli._shared`: that halves what is compiled, and what a short-lived process loads.
"""

import os
import subprocess

from Cython.Build import cythonize
from setuptools import Extension
from setuptools.command.build_ext import build_ext

SHARED = "penink_cli._shared"


class BuildKernels(build_ext):
    """`build_ext` that translates serially and compiles in parallel."""

    def initialize_options(self) -> None:
        """Nothing is known yet of the C compiler."""
        super().initialize_options()
        self._flags: dict[str, bool] = {}

    def finalize_options(self) -> None:
        """Use every processor this process may run on, unless `--parallel` says otherwise."""
        kernels = self.distribution.ext_modules
        if all(kernel.name != SHARED for kernel in kernels):
            kernels.append(Extension(SHARED, [], extra_compile_args=["-O2", "-g0"]))
        super().finalize_options()
        if getattr(self, "parallel", None) is None:
            self.parallel = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()

    def build_extensions(self) -> None:
        """Translate all kernels, then compile them; what is up to date is left as it is."""
        quiet = self.verbose == 0
        translated = cythonize(self.extensions, force=self.force, quiet=quiet, shared_utility_qualified_name=SHARED)
        for kernel, in_c in zip(self.extensions, translated, strict=True):
            kernel.sources = in_c.sources
        for kernel in self.extensions:
            kernel.extra_compile_args = [flag for flag in kernel.extra_compile_args if self._known(flag)]
        super().build_extensions()

    def _known(self, flag: str) -> bool:
        """Whether the C compiler takes the flag: clang refuses gcc's cost models, for one, and needs none."""
        if flag not in self._flags:
            empty = [*self.compiler.compiler, "-Werror", flag, "-fsyntax-only", "-x", "c", os.devnull]
            self._flags[flag] = subprocess.run(empty, capture_output=True, check=False).returncode == 0
        return self._flags[flag]
