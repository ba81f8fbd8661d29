# A program that only simulates needs neither HDF5 nor FFTW from the static library.
cat > sim.c <<'C'
#include <stickslip.h>
int main(void)
{
    ss_scene scene = ss_scene_defaults;
    return ss_sim_run(&scene, &ss_sim_defaults, NULL, NULL) != SS_EINVAL;   /* it lacks a mass */
}
C
# shellcheck disable=SC2046  # flags are a list
$CCLD -I"$SRC/include" -o sim sim.c "$BUILD/libstickslip.a" $(pkg-config --libs gsl) -lm
./sim

# Only these files know these libraries.
cd "$SRC"
grep -lE 'gsl_odeiv2\.h|fftw3\.h|hdf5(_hl)?\.h' -r src tools | sort
