# Files that others wrote, and ours as others read them.
python3 -c 'import h5py, xarray, h5netcdf' 2> /dev/null ||
    { echo "no Python with h5py, xarray and h5netcdf"; exit 77; }
python3 - <<'END'
import h5py, numpy as np
with h5py.File("matlab.mat", "w", userblock_size=512) as f:
    f["y"] = np.arange(6.0).reshape(1, 6)
    f["text"] = np.array([[97], [98]], "u2")
    f["text"].attrs["MATLAB_class"] = np.bytes_("char")
    f["z"] = np.array([1 + 2j])
END
ss-cat --rate 2 matlab.mat:/y
for data in '' :/y :/text :/z; do ss-cat "matlab.mat$data" || echo $?; done
ss-sim compliant-light | ss-morlet --dense -o dense.h5
ss-sim compliant-light | ss-morlet --dense --exact-bits -o exact.h5
ss-sim compliant-light | ss-morlet -o stepped.h5
# the examples of the manual, without their pictures
awk '/^In Python:/ { here = 1 } /^\.Ed/ { block = 0; if (here) n++ } block { print > "example" n ".py" }
    here && /^\.Bd/ { block = 1 }' n=0 "$SRC/man/stickslip-hdf5.5"
for example in dense:0 stepped:1; do
    { echo 'import xarray'; sed 's/run\.h5/'"${example%:*}"'.h5/; s/^abs(\(.*\))\.plot.*/print(abs(\1).dims)/' \
        "example${example#*:}.py"; } | python3 -
done
python3 - <<'END'
import xarray as xr
def show(path, group):
    d = xr.open_dataset(path, engine="h5netcdf", group=group)
    for name in sorted(d.variables):
        print(group, name, d[name].dtype, d[name].dims, d[name].shape, d[name].attrs["units"])
    return d
s = show("dense.h5", "signal")
w = show("dense.h5", "wavelet")
show("stepped.h5", "wavelet/scale100")
assert xr.open_dataset("dense.h5", engine="h5netcdf").attrs["scene"] == "compliant-light"
# of a stepped grid /wavelet has the scales, in the order of its groups
g = show("stepped.h5", "wavelet")
for i in range(g.sizes["scale"]):
    d = xr.open_dataset("stepped.h5", engine="h5netcdf", group="wavelet/scale%03d" % i)
    assert d.attrs["frequency"] == g.frequency[i] and d.attrs["scale"] == g.scale[i] and d.re.dims == ("time",)
if hasattr(xr, "open_datatree"):
    assert "re" in xr.open_datatree("stepped.h5", engine="h5netcdf")["wavelet/scale100"]
assert (w.time.values == s.t.values).all() and "frequency" in w.coords
e = xr.open_dataset("exact.h5", engine="h5netcdf", group="wavelet")
largest = abs(e.re + 1j * e.im).max("time")
assert (abs(w.re - e.re + 1j * (w.im - e.im)).max("time") <= 2e-6 * largest).all()    # 1e-6 each
END
