# The motion of a base comes from a regular file: nothing waits for a pipe or reads a device for ever.
mkfifo fifo
ln -s /dev/zero zero.csv
mkdir folder
for name in fifo zero.csv folder none.csv; do
    sed '/^base_/d' "$SRC/data/scenes/coulomb.scene" > run.scene
    echo "base_file = $name" >> run.scene
    for tool in ss-sim 'ss-sweep -m amplitude --vary friction=1:2:2'; do
        $tool run.scene || echo "status $?"
    done
done
ss-sim -b fifo coulomb || echo "status $?"
ss-sim -b zero.csv:z coulomb || echo "status $?"
