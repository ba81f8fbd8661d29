# A program that only simulates needs nothing of HDF5 from the static library.
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

# Only these know these libraries.
cd "$SRC"
grep -rlE --include='*.[ch]' 'gsl_odeiv2\.h' src tools
grep -rlE --include='*.[ch]' 'include.*(fftw3|fft/plan)\.h' src tools | sort
grep -rlE --include='*.[ch]' 'hdf5(_hl)?\.h' src tools | grep -v '^src/store' || true
