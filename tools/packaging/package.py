# Untried: see README.
from spack.package import *


class Libstickslip(MakefilePackage):
    """Simulate stick-slip oscillators, take Morlet wavelet coefficients of their signals, measure the contact."""

    homepage = "https://github.com/libstickslip/libstickslip"
    url = "https://github.com/libstickslip/libstickslip/releases/download/v1.0.0/libstickslip-1.0.0.tar.gz"
    license("GPL-3.0-or-later")

    version("1.0.0", sha256="0000000000000000000000000000000000000000000000000000000000000000")

    depends_on("c", type="build")
    depends_on("pkgconfig", type="build")
    depends_on("gsl@2.5:")
    depends_on("fftw precision=double")
    depends_on("hdf5+hl~mpi")
    depends_on("gnuplot+cairo", type="run")

    def build(self, spec, prefix):
        make("INSTALL_DEPS=0", f"PREFIX={prefix}")

    def install(self, spec, prefix):
        make("INSTALL_DEPS=0", f"PREFIX={prefix}", "install")
