# Wrong usage is one line and exit 2; a bad scene exit 1; and nothing is written.
try() { ss-sweep "$@" -o a.tsv || echo "exit $?"; }
vary=--vary=mass=1:2:2
try
try $vary coulomb extra
try $vary nowhere.scene
try --vary mass=1:2 coulomb
try --vary mass=1:2:0 coulomb
try --vary mass=0:2:3:log coulomb
try --vary mas=1:2:3 coulomb
try --vary alpha=1:2:3 coulomb
try --vary model=1:2:3 coulomb
try --vary rate=1:2:3 coulomb
try -s model=stribeck --vary stribeck_velocit=1:2:3 coulomb
try $vary $vary coulomb
try $vary --measure speed coulomb
try $vary --measure stops,stops coulomb
try $vary --measure '' coulomb
try $vary --measure transition coulomb
try $vary --measure stops state-variable
try $vary --shoot --measure cycles coulomb
try $vary --method exact state-variable
try $vary --method magic coulomb
try $vary --tol 1 coulomb
try $vary --shard 3 coulomb
try $vary --shard 4/3 coulomb
try $vary --shard 1/0 coulomb
try $vary --threads 0 coulomb
try $vary --max-period 65 coulomb
try $vary --set friction=x coulomb
try $vary --resume b.tsv coulomb
ss-sweep --resume - $vary coulomb || echo "exit $?"
ss-sweep -o a.png $vary coulomb || echo "exit $?"
ls
try --vary friction=0:1:3 --set friction=3 coulomb
try --vary friction=0:1:3 --set ' friction = 3' coulomb
ss-sweep --vary friction=1:2:1e12 coulomb 2>&1 | sed 's/up to [0-9]*$/up to N/'
