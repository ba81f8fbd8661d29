# A million forcing cycles of this scene.
scene=compliant-heavy
. "$SRC/tests/long/million-cycles.inc"
