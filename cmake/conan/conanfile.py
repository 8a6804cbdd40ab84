"""`conan create cmake/conan`: the headers alone, of this checkout, and README's program against them."""

import os
import re

from conan import ConanFile
from conan.tools.build import check_min_cppstd
from conan.tools.cmake import CMake, CMakeToolchain
from conan.tools.files import copy, load


class Gonio(ConanFile):
    name = "gonio"
    description = "Complete BRDFs from a few reflectance measurements"
    license = "MIT"
    package_type = "header-library"
    settings = "os", "compiler", "build_type", "arch"
    requires = "eigen/[>=3.4.0 <6]", "xtensor/[>=0.24.7 <0.28]", "zlib/[>=1.2.11 <2]"
    generators = "CMakeDeps"

    @property
    def _checkout(self):
        return os.path.join(self.recipe_folder, "..", "..")

    def set_version(self):
        text = load(self, os.path.join(self._checkout, "CMakeLists.txt"))
        self.version = re.search(r"project\(gonio VERSION ([0-9.]+)", text).group(1)

    def export_sources(self):
        for pattern in ("CMakeLists.txt", "LICENSE", "cmake/*", "include/*", "examples/data/*"):
            copy(self, pattern, self._checkout, self.export_sources_folder)

    def validate(self):
        check_min_cppstd(self, 20)

    def generate(self):
        toolchain = CMakeToolchain(self)
        for part in ("COMPILED", "TESTS", "EXAMPLES", "BENCH"):
            toolchain.cache_variables[f"GONIO_BUILD_{part}"] = False
        toolchain.cache_variables["GONIO_PARTS"] = ""
        toolchain.generate()

    def build(self):
        CMake(self).configure()

    def package(self):
        CMake(self).install()

    def package_id(self):
        self.info.clear()

    def package_info(self):
        # What CMakeDeps would write of its own knows no components: gonio's own package does.
        self.cpp_info.set_property("cmake_find_mode", "none")
        self.cpp_info.builddirs = [os.path.join("share", "cmake", "gonio")]
        self.cpp_info.bindirs = []
        self.cpp_info.libdirs = []
