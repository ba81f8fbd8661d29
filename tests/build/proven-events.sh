# The event lists of the shipped scenes with a closed form, from their start for 10 s, are the true ones:
# so it is proven in ball arithmetic, of which Arb (FLINT) is an implementation.  So is that of an
# undamped contact in which three zeros of v once fell into one step, and those of rigs that are pulled, on
# belts, damped and of static friction above the kinetic.
# shellcheck source=tests/proof/prove.inc
. "$SRC/tests/proof/prove.inc"
proven 10 coulomb compliant-heavy compliant-light
ss-sim --list -s mass=39.962297470418015 -s stiffness=1210590.7683860338 -s friction=6424.5387020796 \
    -s base_amplitude=.0053703860382076155 -s base_frequency=21.398368727045753 \
    -s contact_stiffness=82309189578.27042 -s contact_damping=0 -s x0=-.00030267041130123407 \
    -s v0=1.115255409262061 compliant-light > undamped.scene
proven 0.8608 undamped.scene
proven rigs 20 | grep -c 'proven$'
