"""The installed tree: a program outside the project builds with it, by CMake and by pkg-config, and every header compiles alone."""
import os
import pathlib
import re
import shlex
import subprocess
import tempfile
import unittest

BUILD = os.environ["HEEL_BUILD_DIR"]
CMAKE = os.environ["HEEL_CMAKE"]
CXX = os.environ["HEEL_CXX"]
OUTSIDE = pathlib.Path(__file__).parent / "outside"
# What a program needs at run time when it links heel::vision and heel::arcos.
ALLOWED_LIBRARIES = re.compile(r"(libhwy|libstdc\+\+|libm|libgcc_s|libc|ld-linux-[\w-]+)\.so\.\d+")


def run(*command, **options):
    """Returns the command's output; the message of a failure holds all of it."""
    done = subprocess.run([str(word) for word in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          timeout=300, check=False, **options)
    if done.returncode != 0:
        raise AssertionError(f"{shlex.join(map(str, command))}: exit status {done.returncode}\n{done.stdout}")
    return done.stdout


class InstalledLibraries(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="heel-install-")
        cls.addClassCleanup(cls.folder.cleanup)
        cls.root = pathlib.Path(cls.folder.name)
        cls.prefix = cls.root / "prefix"
        run(CMAKE, "--install", BUILD, "--component", "dev", "--prefix", cls.prefix)

    def pkg_config(self, *words):
        folder = next(self.prefix.glob("lib/**/pkgconfig"))
        return run("pkg-config", *words, env={**os.environ, "PKG_CONFIG_PATH": str(folder)}).split()

    def check_program(self, program):
        output = run(program)
        features = re.search(r"^(\d+) features$", output, re.MULTILINE)
        self.assertIsNotNone(features, output)
        self.assertGreater(int(features[1]), 100, output)
        self.assertRegex(output, r"(?m)^packet 0x32 of \d+ bytes$")
        needed = re.findall(r"\(NEEDED\).*\[(.+)\]", run("readelf", "-d", program))
        self.assertEqual([name for name in needed if not ALLOWED_LIBRARIES.fullmatch(name)], [])

    def test_outside_program_by_find_package(self):
        build = self.root / "by-cmake"
        run(CMAKE, "-S", OUTSIDE, "-B", build, f"-DCMAKE_PREFIX_PATH={self.prefix}", f"-DCMAKE_CXX_COMPILER={CXX}")
        run(CMAKE, "--build", build)
        self.check_program(build / "outside")

    def test_outside_program_by_pkg_config(self):
        program = self.root / "by-pkg-config"
        run(CXX, "-std=c++20", OUTSIDE / "main.cpp", "-o", program,
            *self.pkg_config("--cflags", "--libs", "heel-vision", "heel-arcos"))
        self.check_program(program)

    def test_arcos_needs_nothing_else(self):
        self.assertEqual(self.pkg_config("--print-requires", "heel-arcos"), [])
        source = self.root / "main.cpp"
        source.write_text("#include <arcos/parser.h>\nint main() { return arcos::Parser().pending_bytes() == 0 ? 0 : 1; }\n")
        build = self.root / "arcos-only"
        (self.root / "CMakeLists.txt").write_text(
            "cmake_minimum_required(VERSION 3.25)\nproject(arcos_only LANGUAGES CXX)\n"
            "find_package(heel REQUIRED COMPONENTS arcos)\nadd_executable(arcos_only main.cpp)\n"
            "target_link_libraries(arcos_only PRIVATE heel::arcos)\n"
            "if(TARGET Eigen3::Eigen OR TARGET heel::vision)\n  message(FATAL_ERROR \"more than was asked for\")\nendif()\n")
        run(CMAKE, "-S", self.root, "-B", build, f"-DCMAKE_PREFIX_PATH={self.prefix}", f"-DCMAKE_CXX_COMPILER={CXX}")
        run(CMAKE, "--build", build)
        run(build / "arcos_only")

    def test_unknown_component_is_named(self):
        (self.root / "CMakeLists.txt").write_text(
            "cmake_minimum_required(VERSION 3.25)\nproject(none LANGUAGES NONE)\n"
            "find_package(heel REQUIRED COMPONENTS legs)\n")
        with self.assertRaisesRegex(AssertionError, r"no component 'legs'\s+\(expected\s+vision\s+or\s+arcos\)"):
            run(CMAKE, "-S", self.root, "-B", self.root / "unknown", f"-DCMAKE_PREFIX_PATH={self.prefix}")

    def test_every_header_compiles_alone(self):
        """Compiles with the installed tree and Eigen only: a public header that includes an internal one fails."""
        flags = ["-std=c++20", "-fsyntax-only", "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-x", "c++", "-"]
        headers = sorted(path.relative_to(self.prefix / "include") for path in self.prefix.glob("include/*/*.h"))
        self.assertTrue({"heel", "arcos"} <= {header.parts[0] for header in headers}, headers)
        for header in headers:
            package = "heel-vision" if header.parts[0] == "heel" else "heel-arcos"
            with self.subTest(header=str(header)):
                run(CXX, *flags, *self.pkg_config("--cflags", package), input=f"#include <{header}>\n")


if __name__ == "__main__":
    unittest.main()
