//! Files of VTK XML whose numbers stand behind the text.

/// The arrays of a file, in the order in which they are declared.
#[derive(Debug, Default)]
pub(super) struct AppendedArrays {
    blocks: Vec<Vec<u8>>,
    offset: usize,
}

impl AppendedArrays {
    /// Adds an array, and returns its declaration.
    ///
    /// * `kind` – of its numbers, `Float64`
    /// * `components` – numbers of each point or cell
    /// * `bytes` – the numbers, little-endian
    pub(super) fn declare(&mut self, name: &str, kind: &str, components: usize, bytes: Vec<u8>) -> String {
        let offset = self.offset;
        self.offset += size_of::<u64>() + bytes.len();
        self.blocks.push(bytes);
        format!(
            "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" format=\"appended\" \
            offset=\"{offset}\"/>\n"
        )
    }

    /// The file.
    ///
    /// * `kind` – of the grid, `StructuredGrid`
    /// * `text` – its contents, with the declarations of the arrays
    pub(super) fn file(self, kind: &str, text: &str) -> Vec<u8> {
        let mut file = format!(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"{kind}\" version=\"1.0\" byte_order=\"LittleEndian\" \
            header_type=\"UInt64\">\n{text}<AppendedData encoding=\"raw\">\n_"
        )
        .into_bytes();
        for block in self.blocks {
            file.extend((block.len() as u64).to_le_bytes());
            file.extend(block);
        }
        file.extend(b"\n</AppendedData>\n</VTKFile>\n");
        file
    }
}
