# A measured base: named by a scene, from the scene's folder, or given; its name and checksum are notes.
mkdir folder
ss-sim -s settle=0 -s duration=8 -c t,z coulomb -o folder/z.tsv
ss-sim --list coulomb | grep -v base_ > folder/my.scene
echo 'base_file = z.tsv' >> folder/my.scene
ss-sim -e folder/my.scene -o named.tsv
ss-sim -e --base folder/z.tsv coulomb -o given.tsv
ss-sim -e -b folder/z.tsv:z coulomb -o column.tsv
for form in named given column; do grep -v '^#' $form.tsv > $form.rows; done
cmp named.rows given.rows && cmp named.rows column.rows && wc -l < named.rows
sum=$(sed -n 's/^# base_cksum: //p' named.tsv)
[ "$sum" = "$(cksum < folder/z.tsv)" ] || echo "$sum: another checksum"
grep '^# base_[cf]' column.tsv | sed 's/cksum: .*/cksum/'
# what is listed is a scene again
ss-sim --list folder/my.scene > folder/again.scene
ss-sim -e folder/again.scene | grep -v '^#' | cmp - named.rows

refused() { "$@" > out || echo "exit $?"; cat out; }
refused ss-sim -s duration=7 folder/my.scene
refused ss-sim -m exact folder/my.scene
refused ss-sim -b folder/z.tsv:y coulomb
refused ss-sim -b folder/none.tsv coulomb
refused ss-sim -b folder/z.tsv:aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa coulomb
refused ss-sim -s base_file=none.tsv folder/my.scene
refused ss-sim -b folder/z.tsv -o folder/z.tsv coulomb
refused ss-sim -o folder/z.tsv folder/my.scene
refused ss-sweep --vary mass=1:2:2 -o folder/z.tsv folder/my.scene
printf 't,z (mm)\n0,1\n1,2\n2,3\n3,2\n4,1\n5,0\n' > mm.csv
refused ss-sim -b mm.csv coulomb
printf 't,z (m)\n0,1\n1,2\n2,3\n5,2\n6,1\n7,0\n' > gap.csv
refused ss-sim -b gap.csv coulomb
ss-cat -q --gaps=interpolate gap.csv -o whole.tsv
ss-sim -e -b whole.tsv -s settle=0 -s duration=1 coulomb | grep -c '^# base_file: whole.tsv'
printf 't,z (m)\n0,1\n1,2\n2,3\n1,2\n4,1\n5,0\n' > folder/back.csv
sed 's/z.tsv/back.csv/' folder/my.scene > folder/back.scene
refused ss-sim folder/back.scene
refused ss-sweep --vary friction=1:1.2:2 folder/my.scene | grep -v '^#'
refused ss-rank folder/z.tsv folder/my.scene
ss-sim --accuracy 1e-6 folder/my.scene | grep -c -v '^#'
