//! Colours of facets in the two bytes behind each, by two conventions that contradict each other.
//!
//! VisCAM: bit 15 set for a colour, 5 bits each for red (highest), green and blue. Magics, whose
//! header holds `COLOR=` and the colour of the whole in 4 bytes: bit 15 clear for a facet's own
//! colour, red in the lowest bits.

use crate::files::face_colors::FaceColors;
use crate::{FileReport, Kind};

const VALID: u16 = 1 << 15;

/// Counts the triangles of each colour, or registers the bytes where they are no colours.
pub(super) fn register(header: &[u8], records: &[[u8; 50]], report: &mut FileReport) {
    let values = || records.iter().map(|record| u16::from_le_bytes([record[48], record[49]]));
    let mut colors = FaceColors::default();
    if let Some(whole) = color_of_whole(header) {
        values().for_each(|value| {
            let [low, middle, high] = channels(value);
            colors.add(if value & VALID == 0 { [low, middle, high, 255] } else { whole }, 1);
        });
    } else {
        let others = values().filter(|value| value & VALID == 0);
        let n_others = others.filter(|&value| value != 0).count();
        if n_others > 0 {
            let id = report.found(Kind::FaceData, "bytes behind facets");
            report.grow(id, n_others as u64, "faces");
        }
        values().filter(|value| value & VALID != 0).for_each(|value| {
            let [low, middle, high] = channels(value);
            colors.add([high, middle, low, 255], 1);
        });
    }
    colors.register(report);
}

/// The colour that a header of Magics gives to facets without their own.
fn color_of_whole(header: &[u8]) -> Option<[u8; 4]> {
    const KEY: &[u8] = b"COLOR=";
    let at = header.windows(KEY.len()).position(|window| window == KEY)?;
    header.get(at + KEY.len()..)?.first_chunk().copied()
}

/// The three channels of 5 bits as bytes, the lowest first.
fn channels(value: u16) -> [u8; 3] {
    [0, 5, 10].map(|shift| {
        let [channel, _] = (value >> shift & 31).to_le_bytes();
        channel << 3 | channel >> 2
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::MeshFormat;

    fn notes(header: &[u8], values: &[u16]) -> Vec<String> {
        let record = |value: &u16| {
            let mut record = [0; 50];
            record[48..].copy_from_slice(&value.to_le_bytes());
            record
        };
        let records: Vec<[u8; 50]> = values.iter().map(record).collect();
        let mut report = FileReport::new(MeshFormat::Stl);
        register(header, &records, &mut report);
        report.notes()
    }

    #[test]
    fn both_conventions() {
        let red = "face colour \"#ff0000\" (2 triangles) is left out";
        assert_eq!(notes(&[0; 80], &[0xFC00, 0xFC00, 0]), [red]);
        let whole = "face colour \"#01020304\" (1 triangle) is left out";
        assert_eq!(notes(b"x COLOR=\x01\x02\x03\x04", &[0x001F, 0x001F, 0x8000]), [whole, red]);
        assert_eq!(notes(&[0; 80], &[0, 0]), [""; 0]);
        assert_eq!(notes(&[0; 80], &[7]), ["face data \"bytes behind facets\" (1 face) is left out"]);
    }
}
