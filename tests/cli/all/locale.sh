# A decimal comma in the user's language changes nothing.
for l in de_DE.UTF-8 fr_FR.UTF-8 C.UTF-8; do
    printf 't/s;x\n0;0,5\n0,25;1,5\n' | LC_ALL="$l" ss-cat | tail -n 2
    printf 't/s;x\n0;0.5\n0.25;1.5\n' | LC_ALL="$l" ss-cat | tail -n 2
done
