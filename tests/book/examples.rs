//! The examples run, and are short.

macro_rules! examples {
    ($($name:ident)*) => {$(
        mod $name {
            include!(concat!(env!("CARGO_MANIFEST_DIR"), "/examples/", stringify!($name), ".rs"));

            #[test]
            fn runs() -> Result<(), Box<dyn Error>> {
                let text = include_str!(concat!("../../examples/", stringify!($name), ".rs"));
                assert!(text.lines().count() <= 40, "an example has at most 40 lines");
                main()
            }
        }
    )*};
}

examples!(batch custom_law read section solve);
