"""Untested: no machine of ours has Conan. `conan create cmake/conan`: the headers alone, of this checkout."""

import os

from conan import ConanFile
from conan.tools.cmake import CMake, CMakeToolchain
from conan.tools.files import copy


class Gonio(ConanFile):
    name = "gonio"
    version = "0.2.0"
    description = "Complete BRDFs from a few reflectance measurements"
    license = "MIT"
    package_type = "header-library"
    settings = "os", "compiler", "build_type", "arch"
    requires = "eigen/3.4.0", "xtensor/0.24.7", "zlib/1.3.1"
    generators = "CMakeDeps"

    def export_sources(self):
        checkout = os.path.join(self.recipe_folder, "..", "..")
        for pattern in ("CMakeLists.txt", "LICENSE", "cmake/*", "include/*", "examples/data/*"):
            copy(self, pattern, checkout, self.export_sources_folder)

    def generate(self):
        toolchain = CMakeToolchain(self)
        for part in ("COMPILED", "TESTS", "EXAMPLES", "BENCH"):
            toolchain.cache_variables[f"GONIO_BUILD_{part}"] = False
        toolchain.generate()

    def build(self):
        CMake(self).configure()

    def package(self):
        CMake(self).install()

    def package_id(self):
        self.info.clear()

    def package_info(self):
        self.cpp_info.bindirs = []
        self.cpp_info.libdirs = []
