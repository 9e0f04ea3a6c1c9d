//! Tests of shapes and filling against closed forms and naive second implementations.

mod text;
