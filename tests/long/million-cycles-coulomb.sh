# A million forcing cycles of this scene.
scene=coulomb
. "$SRC/tests/long/million-cycles.inc"
