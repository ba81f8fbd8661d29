# A million forcing cycles of this scene.
scene=compliant-light
. "$SRC/tests/long/million-cycles.inc"
