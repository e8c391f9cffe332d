//! Every fuzz target as a test.

use crate::{importers, neph, operations, soup};
use bolero::check;
use cap::Cap;
use nephrite_formats::{MeshFormat, VolumeFormat};
use std::alloc::System;

/// Limit for all targets together. An input of a few kilobytes must not need more; a refused
/// allocation ends the process.
#[global_allocator]
static ALLOCATOR: Cap<System> = Cap::new(System, 512 << 20);

#[test]
fn open_and_use() {
    on_this_thread();
    check!().for_each(neph::open_and_use);
}

#[test]
fn query_sequences() {
    on_this_thread();
    check!().for_each(neph::query_edited);
}

#[test]
fn open_operations() {
    on_this_thread();
    check!().for_each(operations::open_operations);
}

#[test]
fn read_ply() {
    on_this_thread();
    check!().for_each(|bytes: &[u8]| importers::read_mesh(bytes, MeshFormat::Ply));
}

#[test]
fn read_obj() {
    on_this_thread();
    check!().for_each(|bytes: &[u8]| importers::read_mesh(bytes, MeshFormat::Obj));
}

#[test]
fn read_stl() {
    on_this_thread();
    check!().for_each(|bytes: &[u8]| importers::read_mesh(bytes, MeshFormat::Stl));
}

#[test]
fn read_off() {
    on_this_thread();
    check!().for_each(|bytes: &[u8]| importers::read_mesh(bytes, MeshFormat::Off));
}

#[test]
fn read_gltf() {
    on_this_thread();
    check!().for_each(|bytes: &[u8]| importers::read_mesh(bytes, MeshFormat::Gltf));
}

#[test]
fn read_glb() {
    on_this_thread();
    check!().for_each(|bytes: &[u8]| importers::read_mesh(bytes, MeshFormat::Glb));
}

#[test]
fn read_vtu() {
    on_this_thread();
    check!().for_each(|bytes: &[u8]| importers::read_volume(bytes, VolumeFormat::Vtu));
}

#[test]
fn read_compressed() {
    on_this_thread();
    check!().for_each(importers::read_compressed);
}

#[test]
fn read_vtk() {
    on_this_thread();
    check!().for_each(|bytes: &[u8]| importers::read_volume(bytes, VolumeFormat::Vtk));
}

#[test]
fn read_gmsh() {
    on_this_thread();
    check!().for_each(|bytes: &[u8]| importers::read_volume(bytes, VolumeFormat::Gmsh));
}

#[test]
fn read_medit() {
    on_this_thread();
    check!().for_each(|bytes: &[u8]| importers::read_volume(bytes, VolumeFormat::Medit));
}

#[test]
fn read_mfem() {
    on_this_thread();
    check!().for_each(|bytes: &[u8]| importers::read_volume(bytes, VolumeFormat::Mfem));
}

#[test]
fn read_plot3d() {
    on_this_thread();
    check!().for_each(|bytes: &[u8]| importers::read_volume(bytes, VolumeFormat::Plot3d));
}

#[test]
fn build_soup() {
    on_this_thread();
    check!().for_each(soup::build_soup);
}

#[test]
fn build_soup_otherwise() {
    on_this_thread();
    check!().for_each(soup::build_soup_otherwise);
}

#[test]
fn refuse_contradictions() {
    on_this_thread();
    check!().for_each(soup::refuse_contradictions);
}

#[test]
fn fuse_soup() {
    on_this_thread();
    check!().for_each(soup::fuse_soup);
}

#[test]
fn write_history() {
    on_this_thread();
    check!().for_each(soup::write_history);
}

/// Tasks this small are not worth giving to other threads.
fn on_this_thread() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).use_current_thread().build();
    // The pool of a thread ends with the thread.
    std::mem::forget(pool);
}
