# SPDX-License-Identifier: MIT
"""Conan 2 recipe of the library. Not tested (packaging/README.md)."""
import os

from conan import ConanFile
from conan.tools.build import stdcpp_library
from conan.tools.cmake import CMake, CMakeToolchain
from conan.tools.files import copy


class Cdprep(ConanFile):
    name = "cdprep"
    version = "0.1.0"
    license = "MIT"
    description = "Exact collision queries on triangle meshes"
    settings = "os", "arch", "compiler", "build_type"
    options = {"shared": [True, False]}
    default_options = {"shared": False}
    package_type = "library"

    def export_sources(self):
        top = os.path.join(self.recipe_folder, "..", "..")
        # A pattern matches in all folders below its own.
        for part in ["CMakeLists.txt", "README.md", "GLOSSARY.md", "CHANGELOG.md", "LICENSES/*",
                     "cmake/*", "format/*", "lib/*", "docs/*", "samples/*"]:
            copy(self, part, src=top, dst=self.export_sources_folder)

    def generate(self):
        toolchain = CMakeToolchain(self)
        for option in ["TOOLS", "TESTS", "SAMPLES", "BENCHMARKS"]:
            toolchain.cache_variables["CDPREP_" + option] = False
        toolchain.generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        CMake(self).install()

    def package_info(self):
        runtime = self.cpp_info.components["cdprep"]
        runtime.libs = ["cdprep"]
        runtime.set_property("cmake_target_name", "cdprep::cdprep")
        if self.settings.os == "Windows" and self.options.shared:
            runtime.defines = ["CDPREP_SHARED"]
        if not self.options.shared:  # a program in C links what the library needs of C++
            runtime.system_libs = [name for name in [stdcpp_library(self)] if name]
            if self.settings.os in ["Linux", "FreeBSD"]:
                runtime.system_libs.append("m")
        cells = self.cpp_info.components["cells"]
        cells.libs = ["cdprep_cells"]
        cells.requires = ["cdprep"]
        cells.set_property("cmake_target_name", "cdprep::cells")
