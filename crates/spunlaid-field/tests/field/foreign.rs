//! Files that are no fields, or no longer read, are refused by name, with what to write instead.

use spunlaid_field::Field;

fn refused(bytes: &[u8], name: &str) -> String {
    Field::parse(bytes, name).expect_err(name).to_string()
}

const PARAVIEW: &str = "open it in ParaView and save one time, or the mean over time, as .vtu";
const FOAM: &str = "convert the case with foamToVTK -latestTime and name its internal.vtu";
const FLUENT: &str = "open it in ParaView and save it as .vtu, or export the cell zone from Fluent as ASCII";

#[test]
fn rejects_tecplot_files_however_they_are_written() {
    let rows = "0 0 20 0\n1 0 19 0\n0 1 20 0\n1 1 19 0\n";
    let names = "VARIABLES = \"X\" \"Y\" \"U\" \"V\"";
    let (repeated, wrapped) = ("0 0 20 2*0.0\n", "0 0 20\n0 1\n");
    for text in [
        format!("TITLE = \"channel\"\n{names}\nZONE I=2, J=2, DATAPACKING=POINT\n{rows}"),
        format!(
            "# made by a solver\n\n {}\nzone t=\"fluid\"\n n=4, e=1, f=fepoint\n{rows}",
            names.to_lowercase()
        ),
        format!("{names}\nZONE I=2, J=2, F=BLOCK\n{rows}"),
        format!("{names}\nZONE T=\"0.0 seconds\", I=2, J=2, F=POINT\n{rows}ZONE T=\"0.1 seconds\"\n{rows}"),
        format!("{names}\nZONE SOLUTIONTIME=0.1D+00, I=2, J=2, F=POINT\n{}", rows.replace("20", "2.0D+01")),
        format!("{names}\nZONE I=2, F=POINT\n{wrapped}"),
        format!("{names}\nZONE I=2, F=POINT\n{repeated}"),
        format!("Variables=X,Y,U,V\r\nZone I=4\r\n{rows}"),
        format!("ZONE T=\"a\"\n{rows}"),
        "FILETYPE = GRID\n".to_owned(),
    ] {
        let wanted = format!("a.dat: is a Tecplot file, which is not read any more; {PARAVIEW}");
        assert_eq!(refused(text.as_bytes(), "a.dat"), wanted, "{text}");
    }
    for start in ["#!TDV112", "#!SZPLT"] {
        let wanted = format!("a.plt: is a binary Tecplot file, which is not read; {PARAVIEW}");
        assert_eq!(refused(format!("{start}\0\u{1}\0").as_bytes(), "a.plt"), wanted);
    }
}

/// The ending says nothing, and columns may have Tecplot’s words as names.
#[test]
fn tables_are_read_whatever_they_are_called() {
    for (head, parting) in [
        ("x y z u v w", " "),
        ("# x y z u v w", " "),
        ("zone,x,y,z,u,v,w", ","),
        ("x,y,z,u,v,w,title", ","),
        ("format,x,y,z,u,v,w", ","),
    ] {
        let columns = head.trim_start_matches("# ").split(parting);
        let row = |i: u32| {
            let cell = |name: &str| match name {
                "x" => (i & 1).to_string(),
                "y" => (i >> 1 & 1).to_string(),
                "z" => (i >> 2).to_string(),
                "u" => "12".to_owned(),
                _ => "0".to_owned(),
            };
            columns.clone().map(cell).collect::<Vec<_>>().join(parting) + "\n"
        };
        let text = format!("{head}\n{}", (0..8).map(row).collect::<String>());
        for name in ["a.dat", "a.plt", "a.tec", "a.sim", "a.case", "a.cas", "a.foam", "a.res"] {
            let (field, warnings) = Field::parse(text.as_bytes(), name).unwrap_or_else(|e| panic!("{e}"));
            assert!(warnings.is_empty(), "{head}: {warnings:?}");
            assert_eq!(field.overview().speed.largest, 12.0, "{head}");
        }
    }
}

#[test]
fn rejects_surfaces_by_name() {
    let said = "is a surface (PolyData), which is not read any more; name the file that holds the interior; a plane \
        flow: open it in ParaView, apply Clean to Grid and save it as .vtu";
    for kind in ["PolyData", "PPolyData"] {
        let text = format!("<?xml version=\"1.0\"?>\n<VTKFile type=\"{kind}\"><{kind}></{kind}></VTKFile>");
        assert_eq!(refused(text.as_bytes(), "a.vtp"), format!("a.vtp: {said}"));
    }
    let text = "# vtk DataFile Version 3.0\na\nASCII\nDATASET POLYDATA\nPOINTS 3 float\n0 0 0 1 0 0 0 1 0\n";
    assert_eq!(refused(text.as_bytes(), "a.vtk"), format!("a.vtk:4: {said}"));
}

#[test]
fn rejects_files_of_other_programs_by_name() {
    let ensight = "FORMAT\ntype: ensight gold\n\nGEOMETRY\nmodel: a.geo\n\nTIME\ntime set: 1\nnumber of steps: 2\n\
        filename start number: 0\nfilename increment: 1\ntime values:\n0.0\n0.1\n";
    let series = "{\"file-series-version\":\"1.0\",\"files\":[{\"name\":\"a.vti\",\"time\":0}]}\n";
    let several_of_series = "a list of several times (.series); the mean flow of a field is that of one; name the file \
        of one time, or of the mean over time";
    let json = "a JSON file, not a field; name the file that holds the air, like .vtu";
    let xdmf = "<?xml version=\"1.0\" ?>\n<!DOCTYPE Xdmf SYSTEM \"Xdmf.dtd\" []>\n\
        <Xdmf Version=\"2.0\"><Domain/></Xdmf>";
    let pvd = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\"><Collection>\
        <DataSet timestep=\"0\" file=\"a.vtu\"/></Collection></VTKFile>";
    let case = "a case of EnSight, which is not read; ";
    let fluent = "a case, mesh or data file of Fluent, which is not read; ";
    let foam = "an empty file by which ParaView opens a case of OpenFOAM; it holds no air; ";
    let own = "a file of OpenFOAM’s own; ";
    let hdf5 = "\u{89}HDF\r\n\u{1a}\n\0\0\0";
    let hdf5: Vec<u8> = hdf5.chars().map(|c| c as u8).collect();
    for (bytes, name, found, remedy) in [
        (&b""[..], "case.foam", foam, FOAM),
        (b"\n", "A.OpenFOAM", foam, FOAM),
        (b"FoamFile\n{\n}\n", "U", own, FOAM),
        (b"/*--------------------------------*- C++ -*------\n", "U", own, FOAM),
        (ensight.as_bytes(), "ensight.case", case, PARAVIEW),
        (b"# a remark\n\nFORMAT\ntype:\tensight\nGEOMETRY\n", "a.encas", case, PARAVIEW),
        (b"C Binary\0\0", "a.geo", "a geometry of EnSight without its values; ", PARAVIEW),
        (series.as_bytes(), "x.vtu.series", several_of_series, ""),
        (b"{\n  \"file-series-version\" : \"1.0\"\n}", "x.pvtu.series", several_of_series, ""),
        (b"{\"air\": 1}", "x.json", json, ""),
        (xdmf.as_bytes(), "x.xdmf", "an XDMF file, which is not read; ", PARAVIEW),
        (b"<Xdmf Version=\"3.0\"/>", "x.xmf", "an XDMF file, which is not read; ", PARAVIEW),
        (
            pvd.as_bytes(),
            "x.pvd",
            "a list of files, often of several times (.pvd); the mean flow of a field is that of one; name one of its \
            files, or that of the mean over time",
            "",
        ),
        (b"(0 \"fluent18.0.0  build-id: 10373\")\n", "a.cas", fluent, FLUENT),
        (b"(1 \"ANSYS\")\n(2 3)\n", "a.msh", fluent, FLUENT),
        (b"((inlet point 10)\n(x 1 2 3))", "a.prof", "a profile of Fluent, values on a boundary; ", FLUENT),
        (&hdf5, "a.cas.h5", "a file of Fluent (HDF5), which is not read; ", FLUENT),
        (&hdf5, "a.dat.h5", "a file of Fluent (HDF5), which is not read; ", FLUENT),
        (&hdf5, "a.cgns", "a CGNS file (HDF5), which is not read; ", PARAVIEW),
        (&hdf5, "a.vtkhdf", "a VTK file in HDF5, which is not read; ", PARAVIEW),
        (&hdf5, "a.h5", "an HDF5 file (of CGNS, Fluent, XDMF or VTK), which is not read; ", PARAVIEW),
        (b"@(#)ADF Database Version", "a.cgns", "a CGNS file, which is not read; ", PARAVIEW),
        (
            b"\0\x01abc",
            "a.sim",
            "a file of STAR-CCM+, which is not read; export the volume mesh from STAR-CCM+ as a table (.csv), or as \
            EnSight and save that as .vtu in ParaView",
            "",
        ),
        (b"\x1f\x8b\x08", "a.vtu.gz", "packed with gzip; ", "unpack it and name the file that was in it"),
        (b"PK\x03\x04", "a.zip", "packed as zip; ", "unpack it and name the file that was in it"),
        (b"PK\x03\x04", "a.xlsx", "a spreadsheet; ", "save its sheet as CSV"),
        (
            b"solid ascii\nfacet",
            "a.stl",
            "a surface (STL), without any air; ",
            "name the file that the CFD program writes",
        ),
    ] {
        assert_eq!(refused(bytes, name), format!("{name}: is {found}{remedy}"));
    }
}

#[test]
fn rejects_the_folder_of_an_openfoam_case_with_the_way_out() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir_all(folder.path().join("system")).unwrap();
    std::fs::write(folder.path().join("system/controlDict"), "FoamFile {}").unwrap();
    let said = Field::read(folder.path()).expect_err("this is no field").to_string();
    assert!(said.ends_with(&format!(": is the folder of a case of OpenFOAM; {FOAM}")), "{said}");
}
