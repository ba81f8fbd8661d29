# What a model is stands in its table: nothing outside the folder of scenes asks which one it has.
cd "$SRC"
grep -rnE --include='*.[ch]' 'SS_(COULOMB|STATE_VARIABLE|COMPLIANT)\b' src tools | grep -v '^src/scene/' || true
# What a method is stands in the list of methods: no other file names one.
grep -rnE --include='*.[ch]' '"(exact|taylor|rk8pd|rkf45|rkck|rk[124](imp)?|bsimp|radau|ms(adams|bdf))\b' src tools | grep -vE '^src/motion/method.c|"exact-bits"' || true
