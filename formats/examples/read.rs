//! Reads mesh files and prints what they hold and how long that took.

#![expect(clippy::print_stdout, reason = "an example shows what it does")]

use std::time::Instant;

fn main() {
    for path in std::env::args().skip(1) {
        let start = Instant::now();
        match nephrite_formats::read_mesh(&path) {
            Ok((mesh, report)) => println!(
                "{path}: {} vertices, {} triangles, {:.1} ms, origin {:?}, rounding {:e}, {:?}, {report:?}",
                mesh.positions.len(),
                mesh.triangles.len(),
                start.elapsed().as_secs_f64() * 1e3,
                mesh.origin,
                mesh.rounding,
                mesh.attributes.iter().map(|a| (&a.name, a.scalar, a.n_components)).collect::<Vec<_>>(),
            ),
            Err(error) => println!("ERROR {error}"),
        }
    }
}
