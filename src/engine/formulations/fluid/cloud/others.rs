//! Particles computed by other ranks, as far as this rank has their values.
//!
//! The loops of most flows need only the particles near those of the rank, and ranks exchange no more than
//! that. Probes, warnings and others that read particles elsewhere request the [whole
//! cloud](FlowCloud::whole) first. In flows that move bodies, and where walls have suction or move relative
//! to each other, all ranks have all particles in every step.

use std::cell::Ref;
use std::ops::Range;

use super::flow_cloud::FlowCloud;
use crate::formulations::fluid::lanes::FlowParticle;
use crate::formulations::fluid::lists::blocks::{Blocks, Packed};
use crate::parallel::{BLOCK, Lanes4, others_rows, share_rows_of};
use crate::ranks::{self, Halo, has_several};
use crate::schedule::Resources;
use crate::world::{MissingColumn, Velocity, World};

impl FlowCloud {
    /// Decides whether its loops need only the particles near their own ones: where all its boundaries are
    /// walls without suction, and `has_edges` is false: no probe requests forces at edges between them.
    pub(in crate::formulations::fluid) fn decide_what_others_know(&mut self, has_edges: bool) {
        let bounds = || self.groups.iter().filter(|group| group.fluid().is_none());
        let is_plain = bounds().all(|group| group.is_wall() && !group.has_suction() && !group.short);
        let has_blocks = self.blocks.as_ref().is_some_and(|blocks| !blocks.hides);
        self.others.may_be_local = has_blocks
            && is_plain
            && !has_edges
            && !self.neighborhoods.iter().any(|near| near.is_soft || near.has_friction);
        self.others.is_local = self.others.may_be_local;
    }

    /// Decides it for a step: where walls move relative to each other, loops need all particles beside their
    /// edges. Returns whether the decision has changed.
    pub(super) fn decide_for_step(&mut self, world: &World) -> Result<bool, MissingColumn> {
        if !(has_several() && self.others.may_be_local) {
            return Ok(false);
        }
        let is_local = !self.have_walls_parted(world)?;
        Ok(std::mem::replace(&mut self.others.is_local, is_local) != is_local)
    }

    /// Whether any two walls move relative to each other.
    fn have_walls_parted(&self, world: &World) -> Result<bool, MissingColumn> {
        let bounds = || self.groups.iter().filter(|group| group.fluid().is_none());
        if bounds().count() < 2 {
            return Ok(false);
        }
        let mut first = None;
        for group in bounds() {
            let velocity = world.phase(group.phase).read::<Velocity>()?;
            let mut of_group = velocity[group.rows.clone()].iter().map(|velocity| velocity.0);
            let first = *first.get_or_insert(velocity[group.rows.start].0);
            if of_group.any(|v| v != first) {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Whether ranks have only those particles of others that are near their own ones.
    pub(in crate::formulations::fluid) fn is_local(&self) -> bool {
        self.others.is_local && has_several()
    }

    /// The cloud of a simulation, if there is one, with the records of all particles. All ranks ask together.
    pub fn whole(resources: &Resources) -> Option<Ref<'_, Self>> {
        Self::complete(resources);
        resources.try_get()
    }

    /// Exchanges the records of all particles, where ranks know some alone.
    pub(in crate::formulations::fluid) fn complete(resources: &Resources) {
        // Loops ask for the cloud while they read it, so that it is written where something is missing alone.
        let lacks_some = |cloud: Ref<'_, Self>| cloud.is_local() && !cloud.others.is_whole;
        if has_several()
            && resources.try_get::<Self>().is_some_and(lacks_some)
            && let Some(mut cloud) = resources.to_complete::<Self>()
        {
            let Self { records, groups, others, .. } = &mut *cloud;
            share_rows_of(records, groups.iter().map(|group| group.cloud.clone()));
            others.is_whole = true;
        }
    }

    /// Packs all particles, and gets those of other ranks.
    pub(in crate::formulations::fluid) fn pack_all(&mut self, world: &World) -> Result<(), MissingColumn> {
        self.pack(world)?;
        let is_local = std::mem::take(&mut self.others.is_local);
        self.share_records(world)?;
        self.others.is_local = is_local;
        Ok(())
    }

    /// Divides boundaries among ranks by the fluid beside them, once new lists tell where that is: most of a
    /// tank is dry, and its wet part may be in the first rows.
    pub(super) fn divide_boundaries(&mut self, world: &World) {
        let Some(cut) = ranks::cut().filter(|_| !std::mem::replace(&mut self.pairs.are_weighed, true)) else {
            return;
        };
        let lists = &self.pairs.boundary;
        let weight = |rows: Range<usize>| {
            let pairs: usize = rows.clone().map(|row| lists.row(row - self.fluid).len()).sum();
            (OF_PARTICLE * rows.len() + pairs) as f64
        };
        let mut weighed = None;
        for Range { start, end } in self.groups.iter().map(|group| group.cloud.clone()) {
            if start >= self.fluid {
                let blocks = (start..end).step_by(BLOCK).map(|first| first..(first + BLOCK).min(end));
                let weights: Vec<f64> = blocks.map(weight).collect();
                weighed = weighed.as_ref().unwrap_or(&cut).weighed(&weights).or(weighed);
            }
        }
        if let Some(cut) = weighed {
            world.phases().for_each(|phase| world.phase(phase).complete_all());
            ranks::set_cut(cut);
        }
    }

    /// Finds which rows of other ranks are near those of this one, once lists have been built.
    pub(super) fn find_halo(&mut self) {
        if !self.is_local() {
            return;
        }
        let Self { groups, blocks: Some(blocks), others, fluid, records, .. } = self else { return };
        let lists = &blocks.lists;
        others.wanted.clear();
        others.wanted.resize(records.len(), false);
        let mut want = |row: &[u32]| row.iter().for_each(|&j| others.wanted[j as usize] = true);
        for block in lists.others.own().iter().cloned().flatten() {
            match block.checked_sub(lists.walls.rows()) {
                Some(block) => want(lists.boundary.row(block)),
                None => {
                    want(lists.fluid.row(block));
                    want(lists.walls.row(block));
                }
            }
        }
        let bodies = |are_fluids: bool| -> Vec<Range<usize>> {
            let all = groups.iter().map(|group| group.cloud.clone());
            all.filter(|rows| (rows.end <= *fluid) == are_fluids).collect()
        };
        others.fluids = Halo::of(&bodies(true), BLOCK, &others.wanted);
        others.boundaries = Halo::of(&bodies(false), BLOCK, &others.wanted);
    }

    /// Gets records of other ranks: their places and motions.
    pub(super) fn share_records(&mut self, world: &World) -> Result<(), MissingColumn> {
        if !has_several() {
            return Ok(());
        }
        if !self.others.is_local {
            share_rows_of(
                &mut self.records,
                self.groups.iter().map(|group| group.cloud.clone()).take_while(|rows| rows.end <= self.fluid),
            );
            self.repack_others(|packed, record, blocks| packed.take(record, &blocks.units));
            return Ok(());
        }
        let Self { records, blocks: Some(blocks), others, groups, .. } = self else { return Ok(()) };
        others.is_whole = false;
        let Blocks { packed, units, .. } = &mut **blocks;
        others.fluids.fill_with(
            &mut (&mut records[..], &mut packed[..]),
            |(records, _), row| records[row],
            |(records, packed), row, record| {
                records[row] = record;
                packed[row].take(&record, units);
            },
        );
        for &row in others.fluids.unread() {
            records[row as usize] = UNUSABLE;
            packed[row as usize].take(&UNUSABLE, units);
        }
        for group in groups.iter().filter(|group| group.fluid().is_none()) {
            let velocity = world.phase(group.phase).read::<Velocity>()?;
            for &row in others.boundaries.rows() {
                let row = row as usize;
                if let Some(k) = row.checked_sub(group.cloud.start).filter(|k| *k < group.cloud.len()) {
                    records[row].motion = Lanes4::new(velocity[group.rows.start + k].0, 0.0);
                    packed[row].take_state(&records[row]);
                }
            }
        }
        Ok(())
    }

    /// Gets volumes and pressures of fluid particles of other ranks.
    pub(in crate::formulations::fluid) fn share_states(&mut self) {
        if !has_several() {
            return;
        }
        let state_of = |record: &FlowParticle| [record.place.0[3], record.motion.0[3]];
        let set = |record: &mut FlowParticle, [volume, pressure]: [f64; 2]| {
            record.place.0[3] = volume;
            record.motion.0[3] = pressure;
        };
        if !self.others.is_local {
            let mut states = std::mem::take(&mut self.others.states);
            states.clear();
            states.extend(self.records[..self.fluid].iter().map(state_of));
            share_rows_of(&mut states, self.fluids());
            self.records.iter_mut().zip(&states).for_each(|(record, state)| set(record, *state));
            self.others.states = states;
            return self.repack_others(|packed, record, _| packed.take_state(record));
        }
        let Self { records, blocks: Some(blocks), others, .. } = self else { return };
        others.is_whole = false;
        others.fluids.fill_with(
            &mut (&mut records[..], &mut blocks.packed[..]),
            |(records, _), row| state_of(&records[row]),
            |(records, packed), row, state| {
                set(&mut records[row], state);
                packed[row].take_state(&records[row]);
            },
        );
    }

    /// Gets velocities and pressures of boundary particles of other ranks that are near own particles.
    pub(in crate::formulations::fluid) fn share_boundaries(&mut self) {
        let Self { records, blocks: Some(blocks), others, .. } = self else { return };
        others.is_whole = false;
        others.boundaries.fill_with(
            &mut (&mut records[..], &mut blocks.packed[..]),
            |(records, _), row| records[row].motion,
            |(records, packed), row, motion| {
                records[row].motion = motion;
                packed[row].take_state(&records[row]);
            },
        );
    }

    /// Packs fluid particles of other ranks again for sums in single precision.
    fn repack_others(&mut self, pack: impl Fn(&mut Packed, &FlowParticle, &Blocks)) {
        let Some(mut blocks) = self.blocks.take() else { return };
        let mut packed = std::mem::take(&mut blocks.packed);
        for row in self.fluids().flat_map(|fluid| others_rows(&fluid)).flatten() {
            pack(&mut packed[row], &self.records[row], &blocks);
        }
        blocks.packed = packed;
        self.blocks = Some(blocks);
    }
}

/// Cost of a boundary particle, in pairs with fluid particles.
const OF_PARTICLE: usize = 2;

/// A record that nobody can use.
const UNUSABLE: FlowParticle = FlowParticle { place: Lanes4([f64::NAN; 4]), motion: Lanes4([f64::NAN; 4]) };
