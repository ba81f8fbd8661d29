# Untried: see README.
class Libstickslip < Formula
  desc "Stick-slip oscillators and the wavelets of their signals"
  homepage "https://github.com/libstickslip/libstickslip"
  url "https://github.com/libstickslip/libstickslip/releases/download/v1.0.0/libstickslip-1.0.0.tar.gz"
  sha256 "0000000000000000000000000000000000000000000000000000000000000000"
  license "GPL-3.0-or-later"

  depends_on "pkgconf" => :build
  depends_on "fftw"
  depends_on "gnuplot"
  depends_on "gsl"
  depends_on "hdf5"

  def install
    system "make", "INSTALL_DEPS=0", "PREFIX=#{prefix}", "install"
  end

  test do
    assert_match "contact_stiffness", pipe_output("#{bin}/ss-features --mass 2.42 --stiffness 2310",
                                                  shell_output("#{bin}/ss-sim compliant-light"))
  end
end
